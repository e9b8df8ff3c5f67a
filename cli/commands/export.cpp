// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "cli/arguments.h"
#include "cli/chain_from_start.h"
#include "cli/exchange/explicit_chain.h"
#include "cli/exchange/imported.h"
#include "cli/exchange/trajectories.h"
#include "cli/render/files.h"
#include "cli/render/matrix.h"
#include "cli/render/version.h"
#include "cli/source_options.h"
#include "cli/terminal/output.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/source/cell_matrix.h"
#include "lattice/source/start_text.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

struct ExportCommand : Options {
  using Options::Options;
  TextOption matrix = positional("matrix", "matrix file written by gatewalk build", true);
  TextOption second = second_scene();
  TextOption output = main_output_file("FILE", "the file to write", Options::Content::binary);
  Option gate = add_flag(
      "gate", "for .mtx, .csv, .npz: write the matrix of one gate; its last column is trapped");
  Option counts = add_flag("counts", "with --gate: write numbers of runs, not probabilities");
  TextOption type = add_text(
      "type", "NAME", "with --gate: the matrix of gates of this type of the table [terrain]");
  TextsOption start = add_starts(*this, "the scene's start");
  Option seed_given = add_seed("seed of trials of a start that a matrix of trees does not know");
  Asked asked{.path = matrix, .scene = second, .starts = start};
};

enum class ExportForm { umb, drn, prism, matrix_market, csv, npz, trajectories };

/// The format by the ending of the file's name. Throws UsageError naming all endings.
ExportForm export_form(const std::string& output) {
  constexpr std::pair<const char*, ExportForm> kForms[] = {
      {".umb", ExportForm::umb},   {".drn", ExportForm::drn},
      {".tra", ExportForm::prism}, {".mtx", ExportForm::matrix_market},
      {".csv", ExportForm::csv},   {".dtrajs.npz", ExportForm::trajectories},
      {".npz", ExportForm::npz},   {".dtrajs", ExportForm::trajectories}};
  for (const auto& [ending, form] : kForms)
    if (lattice::has_ending(output, ending)) return form;
  throw UsageError(fmt::format(
      "-o {}: must end in .umb, .drn, .tra, .mtx, .csv, .npz, .dtrajs or .dtrajs.npz", output));
}

/// The name of a file without its ending (without both for .dtrajs.npz).
std::string stem_of(const std::string& output) {
  constexpr std::string_view kBoth = ".dtrajs.npz";
  return output.substr(
      0, lattice::has_ending(output, kBoth) ? output.size() - kBoth.size() : output.rfind('.'));
}

/// Throws UsageError if a file to be written beside the file of -o is an input or another output,
/// or cannot be written.
void check_files_beside(const ExportCommand& options, ExportForm form) {
  const std::string output = options.output.value(), stem = stem_of(output);
  std::vector<std::string> files;
  if (form == ExportForm::prism) files = {stem + ".sta", stem + ".lab"};
  if (form == ExportForm::matrix_market || form == ExportForm::csv || form == ExportForm::npz ||
      form == ExportForm::trajectories)
    files = {stem + ".states.csv"};
  for (const std::string& file : files) {
    for (const std::string& input : options.files_read()) {
      std::error_code missing;
      if (std::filesystem::equivalent(file, input, missing))
        throw UsageError(fmt::format(
            "{}, which is written beside -o {}, is an input: give -o another name", file, output));
    }
    for (const TextOption& other : {options.json, options.csv})
      if (other && std::filesystem::weakly_canonical(other.value()) ==
                       std::filesystem::weakly_canonical(file))
        throw UsageError(fmt::format("--{} {}: is written beside -o {}: give it another name",
                                     other.name(), other.value(), output));
    try {
      require_writable(file);
    } catch (const std::runtime_error& e) {
      throw UsageError(std::string("beside -o: ") + e.what());
    }
  }
}

/// Writes the table of states beside the file of -o. A matrix file with the same name and another
/// ending would lose its states to another table: throws UsageError, or warns with --force.
void write_states(const ExportCommand& options, const std::string& states) {
  const std::string output = options.output.value(), stem = stem_of(output),
                    file = stem + ".states.csv";
  std::ifstream in(file, std::ios::binary);
  std::error_code missing;
  if (in && std::string(std::istreambuf_iterator<char>(in), {}) != states)
    for (const char* ending : {".mtx", ".csv", ".npz", ".dtrajs", ".dtrajs.npz"})
      if (const std::string other = stem + ending;
          other != output && std::filesystem::exists(other, missing)) {
        const std::string what =
            fmt::format("{} has the states of {}, which are others", file, other);
        if (!options.force) throw UsageError(what + ": give -o another name");
        options.warn(what + ": they are replaced");
      }
  options.write(file, states);
}

/// Writes a sparse matrix, and the table of its states beside it.
void write_table(const ExportCommand& options, ExportForm form, const SparseTable& table,
                 const std::vector<std::string>& rows, const std::vector<std::string>& columns,
                 const std::string& states) {
  const std::string output = options.output.value();
  write_states(options, states);
  if (form == ExportForm::matrix_market)
    options.write(output, matrix_market_of(table, fmt::format("gatewalk {}: {}", kVersion,
                                                              options.canonical())));
  else if (form == ExportForm::csv)
    options.write(output, csv_of(table, rows, columns, table.whole ? "count" : "probability"));
  else
    options.write(output, npz_of(table));
}

/// What was written, as numbers and in words.
struct Exported {
  ExportResult result;
  std::string text;
};

Exported export_field(const ExportCommand& options, ExportForm form) {
  lattice::Source s = open_source(options, options.asked);
  if (s.starts.size() > 1) throw UsageError("--start: a chain has one");
  const StartedChain from = chain_from_start(options, s);
  const lattice::FieldParams& field = s.problem.field;
  const auto chain =
      markov::explicit_chain(from.chain, {field.columns, field.rows}, from.start, field.max_gates);
  const std::string output = options.output.value();
  if (form == ExportForm::umb) {
    options.write(output, umb_of(chain, options.canonical()));
  } else if (form == ExportForm::drn) {
    options.write(output, drn_of(chain));
  } else if (form == ExportForm::prism) {
    const dynamics::StateSpace& space = s.is_imported ? s.file->transitions.space : from.space;
    std::vector<int> numbers;
    for (int state = 0; state < space.size(); ++state)
      numbers.push_back(lattice::shown_number(space, state));
    const PrismFiles files = prism_of(chain, numbers);
    options.write(stem_of(output) + ".sta", files.states);
    options.write(stem_of(output) + ".lab", files.labels);
    options.write(output, files.transitions);
  } else {
    const std::vector<std::string> names =
        s.is_imported ? lattice::state_names(*s.file) : lattice::state_names(from.space);
    const std::vector<std::string> all = names_of(chain, names);
    write_table(options, form, table_of(chain), all, all, states_csv(chain, names));
  }
  return {
      {.states = chain.size(),
       .transitions = std::ssize(chain.target),
       .first_ending = chain.ends(),
       .made_by = options.provenance(s)},
      fmt::format("{} states, {} transitions.\nState 0 is {}; the last {} states are endings.\n",
                  chain.size(), chain.target.size(),
                  from.state ? from.state->bin
                             : lattice::title_of(s.problem.map().section, s.starts.front()),
                  kEndingLabels.size())};
}

/// Counts per run for each row; `rows` may be the rows of one type of gate. Empty: each run is one
/// count.
std::vector<std::int64_t> counts_per_run_of(const ExportCommand& options,
                                            const lattice::MatrixFile& file,
                                            const dynamics::Transitions& rows) {
  if (!rows.space.has_trees()) return lattice::counts_per_run(file);
  const lattice::Source s = open_source(options, options.asked);
  const std::vector<dynamics::Transitions> matrices = s.matrices();
  const auto at = std::find_if(matrices.begin(), matrices.end(),
                               [&](const auto& m) { return m.rows == rows.rows; });
  const lattice::CountedField counted = lattice::counted_of(s);
  return counted.images.at(static_cast<std::size_t>(at - matrices.begin()));
}

Exported export_gate(const ExportCommand& options, ExportForm form) {
  const std::string path = options.matrix.value();
  const lattice::MatrixFile& file = *options.file(path).matrix();
  const auto type = file.types.find(options.type.value());
  if (options.type && type == file.types.end())
    throw UsageError(fmt::format("--type {}: {} has no such type", options.type.value(), path));
  const dynamics::Transitions& t = options.type ? type->second : file.transitions;
  if (const auto states = recorded_states(file, path);
      options.counts && states && states->are_probabilities)
    throw UsageError(
        fmt::format("--counts: {} was made of probabilities, and has no counts", path));
  const std::vector<int> order = lattice::shown_order(t.space);
  const SparseTable table = options.counts
                                ? table_of(in_order(t.counts(), order))
                                : table_of(in_order(lattice::make_chain(t).matrix(), order));
  const std::vector<std::string> all = lattice::state_names(file);
  std::vector<std::string> names;
  for (const int s : order) names.push_back(all[static_cast<std::size_t>(s)]);
  names.push_back(all.back());
  const std::vector<std::int64_t> per_run = counts_per_run_of(options, file, t);
  write_table(options, form, table, names, names, states_csv(file, per_run));
  std::string text = fmt::format("{} of one gate, {} entries. The last column is trapped.\n",
                                 states_words(t.space), table.entries.size());
  if (options.counts && std::count(per_run.begin(), per_run.end(), 2) > 0)
    text += fmt::format(
        "Some rows count each run and its mirror image: see counts_per_run in {}.states.csv.\n",
        stem_of(options.output.value()));
  return {{.states = t.space.size(),
           .transitions = std::ssize(table.entries),
           .made_by = options.provenance()},
          text};
}

Exported export_trials(const ExportCommand& options) {
  const lattice::Source s = open_source(options, options.asked);
  if (!s.pool)
    throw UsageError(fmt::format(
        "{}: keeps no trials: it was not made of trees or recorded runs{}", s.path,
        s.is_imported
            ? ", and of trajectories import keeps the counts of their steps, which --gate "
              "--counts -o FILE.mtx writes"
            : ""));
  const dynamics::StateSpace& space = s.file->transitions.space;
  const Trajectories all = trajectories_of(*s.pool, space);
  const std::string output = options.output.value();
  const auto per_run = counts_per_run_of(options, *s.file, s.file->transitions);
  write_states(options, states_csv(*s.file, per_run));
  options.write(output, lattice::has_ending(output, ".npz") ? npz_of(all) : text_of(all));
  return {
      {.states = space.size(), .trajectories = std::ssize(all), .made_by = options.provenance(s)},
      fmt::format("{} trajectories through {}. State {} is trapped.\n", all.size(),
                  states_words(space), space.size())};
}

/// A sentence on how other programs read the file.
std::string how_to_read(ExportForm form, const std::string& output) {
  switch (form) {
    case ExportForm::umb:
      return "PRISM (from 4.10) and Storm (from 1.12) read this file.\n";
    case ExportForm::drn:
      return "Storm reads this file.\n";
    case ExportForm::prism:
      return fmt::format("PRISM reads this file; {0}.sta and {0}.lab are beside it.\n",
                         stem_of(output));
    case ExportForm::npz:
      return "Python reads this file with scipy.sparse.load_npz.\n";
    case ExportForm::matrix_market:
      return "Python reads this file with scipy.io.mmread.\n";
    case ExportForm::csv:
      return "The states are in " + stem_of(output) + ".states.csv.\n";
    case ExportForm::trajectories:
      break;
  }
  return "deeptime and PyEMMA take such trajectories; the states are in " + stem_of(output) +
         ".states.csv.\n";
}

}  // namespace

int run_export(const Arguments& arguments) {
  ExportCommand options(
      "export MATRIX.nc [SCENE] -o FILE [options]",
      "Writes a chain for other programs. The ending of FILE says for which one:\n"
      "  .umb              PRISM (from 4.10), Storm (from 1.12)\n"
      "  .drn              Storm\n"
      "  .tra              PRISM, with .sta and .lab beside it\n"
      "  .mtx              Matrix Market; this and all below with .states.csv beside the file\n"
      "  .csv              from,to,probability, with names of states\n"
      "  .npz              compressed rows, for scipy.sparse.load_npz\n"
      "  .dtrajs           a line for each trial, with the states it visited (deeptime, PyEMMA)\n"
      "  .dtrajs.npz       the same as arrays of numpy\n"
      "All but the last two have the chain of the whole field. A state is then a gate, the way in "
      "which a\n"
      "body enters the gate and, where field.max_gates sets a limit, the number of gates before. "
      "Endings\n"
      "are absorbing states: trapped, crossed, left_side, right_side, went_back, cut_off, "
      "never_sampled.\n"
      "--gate writes the matrix of one gate. States count from 0 (.mtx: from 1).",
      "gatewalk build scenes/field.toml --accuracy 0.1 -o matrix.nc\n"
      "  gatewalk export matrix.nc --set field.max_gates=0 -o field.umb");
  options.most_used({"output", "gate", "counts", "set", "start"});
  if (!options.parse(arguments)) return kFine;
  const ExportForm form = export_form(options.output.value());
  check_files_beside(options, form);
  const bool sparse =
      form == ExportForm::matrix_market || form == ExportForm::csv || form == ExportForm::npz;
  if (form == ExportForm::trajectories) {
    refuse({options.start, options.set}, "for trajectories, which are the trials as they were run");
    if (!options.second.value().empty())
      throw UsageError(
          "SCENE has no meaning for trajectories, which are the trials as they were run");
  }
  if (!options.gate) {
    refuse({options.counts, options.type}, "without --gate");
  } else {
    if (!sparse) throw UsageError("--gate: is for .mtx, .csv and .npz");
    refuse({options.start, options.set}, "beside --gate: a gate's matrix knows no field");
    if (!options.second.value().empty())
      throw UsageError("SCENE has no meaning beside --gate: a gate's matrix knows no field");
  }
  if (const lattice::SourceFile& file = options.file(options.matrix.value()); !file.is_matrix())
    (void)file.matrix();  // throws an error that says what the file is
  const Exported exported = options.gate                       ? export_gate(options, form)
                            : form == ExportForm::trajectories ? export_trials(options)
                                                               : export_field(options, form);
  options.give_out(exported.result, exported.text + how_to_read(form, options.output.value()));
  return kFine;
}

}  // namespace gatewalk::cli
