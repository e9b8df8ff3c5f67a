#include <filesystem>
#include <system_error>

#include "cli/arguments.h"
#include "cli/render/explicit_chain.h"
#include "cli/render/json.h"
#include "cli/render/version.h"
#include "cli/walked.h"

namespace gatewalk::cli {

int run_export(const Arguments& arguments) {
  Options options(
      "export MATRIX.nc [SCENE] -o FILE.umb|.drn|.tra [options]",
      "Writes the field's Markov chain state by state, for other programs: .umb for PRISM (from\n"
      "4.10) and Storm (from 1.12), .drn for Storm, .tra for PRISM, with .sta and .lab beside it.\n"
      "A state is a gate, the state in which it is entered and, where field.max_gates limits\n"
      "them, how many were entered before. Endings are states that are never left, with labels:\n"
      "trapped, crossed, left_side, right_side, went_back, cut_off, never_sampled. All count from "
      "0.",
      "gatewalk export matrix.nc --set field.max_gates=0 -o field.umb");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  options.main_output_file("FILE.umb|drn|tra", "what to write", Options::Content::binary);
  add_starts(options, "the scene's start");
  options.add_seed("seed of trials of a start that a matrix of trees does not know");
  if (!options.parse(arguments)) return kFine;
  const std::string path = options.text("matrix"), output = options.text("output");
  const std::string stem = output.size() < 4 ? "" : output.substr(0, output.size() - 4);
  const bool umb = output.ends_with(".umb"), drn = output.ends_with(".drn");
  if (!umb && !drn && !output.ends_with(".tra"))
    throw UsageError("-o " + output + ": must end in .umb, .drn or .tra");
  const std::vector<std::string> beside =
      umb || drn ? std::vector<std::string>() : std::vector{stem + ".sta", stem + ".lab"};
  for (const std::string& file : beside)
    for (const std::string& input : options.files_read()) {
      std::error_code missing;
      if (std::filesystem::equivalent(file, input, missing))
        throw UsageError(file + ", which is written beside -o " + output +
                         ", is an input: give -o another name");
    }
  if (!is_matrix(path)) (void)read_matrix(options);  // says what it is instead
  Subject s = open_subject(options, "matrix");
  if (s.starts.size() > 1) throw UsageError("--start: a chain has one");
  const Walked walked = walked_chain(options, s);
  const lattice::FieldParams& field = s.problem.field;
  const auto chain = markov::explicit_chain(walked.chain, {field.columns, field.rows}, walked.start,
                                            field.max_gates);
  if (umb) {
    options.write(output, umb_of(chain, {{"tool", "gatewalk"},
                                         {"tool-version", kVersion},
                                         {"parameters", options.canonical()}}));
  } else if (drn) {
    options.write(output, drn_of(chain));
  } else {
    const PrismFiles files = prism_of(chain);
    options.write(beside[0], files.states);
    options.write(beside[1], files.labels);
    options.write(output, files.transitions);
  }
  Json json = {
      {"states", chain.size()}, {"transitions", chain.target.size()}, {"initial_state", 0}};
  Json labels = Json::object();
  for (std::size_t e = 0; e < ending_labels().size(); ++e)
    labels[ending_labels()[e]] = chain.ends() + static_cast<std::int64_t>(e);
  json["endings"] = labels;
  json["made_by"] = s.made_by(options);
  options.give_out(json, std::to_string(chain.size()) + " states, " +
                             std::to_string(chain.target.size()) + " transitions; state 0 is " +
                             walked.start_text + ", the last " +
                             std::to_string(ending_labels().size()) + " are endings\n");
  return kFine;
}

}  // namespace gatewalk::cli
