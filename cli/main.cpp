// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "cli/commands.h"
#include "cli/fields/schema.h"
#include "cli/help.h"
#include "cli/kept/kept_run.h"
#include "cli/kept/ranks.h"
#include "cli/render/version.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"
#include "lattice/scene/scene.h"
#include "lattice/text/edit_distance.h"
#include "lattice/text/text_stream.h"
#include "markov/formats/counts.h"
#include "markov/formats/file.h"

namespace gatewalk::cli {
namespace {

void print_help(std::ostream& out) {
  out << "gatewalk " << kVersion
      << ": how bodies move through cluttered obstacles, by simulation and Markov chains\n\n"
         "usage: gatewalk COMMAND [arguments] [options]\n\n"
         "Begin with: gatewalk sample walker -o walker.toml; gatewalk predict walker.toml\n\n";
  bool is_first = true;
  for (const Command& c : kCommandsAndGroups) {
    if (!c.run)
      out << (is_first ? "" : "\n") << c.name << "\n";
    else
      out << "  " << std::left << std::setw(15) << c.name << c.summary << "\n";
    is_first = false;
  }
  out << "\ngatewalk help COMMAND explains a command and gives an example.\n"
         "gatewalk --version --verbose shows the version and how the program was built.\n"
         "exit status: 0 fine, 1 failure (with --strict also a result whose status is not clean),\n"
         "2 wrong use or input, 130 stopped by ctrl-C, SIGTERM, SIGHUP or SIGUSR1, 75 stopped and\n"
         "--resume continues, 141 the reader of a pipe has closed it (| head)\n";
}

/// The command of that name. For an unknown name, prints an error with a suggestion and returns
/// null. `otherwise` prints what helps if there is no suggestion.
const Command* find_command(const std::string& name,
                            void (*otherwise)(std::ostream& out) = print_help) {
  if (const Command* const named = command_named(name)) return named;
  std::cerr << "gatewalk: no command '" << name << "'";
  if (std::error_code error; std::filesystem::is_regular_file(name, error)) {
    std::cerr << ", but a file: the command comes first, gatewalk COMMAND " << name << "\n";
    return nullptr;
  }
  std::vector<std::string> names;
  for (const Command& c : commands()) names.emplace_back(c.name);
  if (name.starts_with('-')) names = {"--help", "--version"};
  if (const std::string meant = lattice::meant_name(name, names); !meant.empty()) {
    std::cerr << "; did you mean " << meant << "?\n";
    return nullptr;
  }
  std::cerr << "\n\n";
  otherwise(std::cerr);
  return nullptr;
}

/// How many of the words form the name of a command: one or two (chart field).
std::size_t words_of_name(const std::vector<std::string>& words) {
  return words.size() > 1 && command_named(words[0] + " " + words[1]) ? 2 : 1;
}

/// The commands whose name begins with `chart`, a line each.
std::string charts() {
  std::string lines;
  for (const Command& c : commands())
    if (std::string_view(c.name).starts_with("chart "))
      lines += fmt::format("  gatewalk {:<15}{}\n", c.name, c.summary);
  return lines;
}

/// Commands that were renamed in version 2.0. The rename of `chart` applies where the next word
/// names no chart.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kRenamed{
    {{"chart-chain", "chart chain"},
     {"chart-field", "chart field"},
     {"stability", "chart limits SCENE"},
     {"chart", "chart methods"}}};

/// Throws UsageError for a command's old name; the message gives the new one.
void refuse_old_name(const std::vector<std::string>& words) {
  const auto* const old = std::find_if(kRenamed.begin(), kRenamed.end(),
                                       [&](const auto& r) { return r.first == words[0]; });
  if (old == kRenamed.end() || words_of_name(words) == 2) return;
  if (words == std::vector<std::string>{"chart"})
    throw UsageError("chart needs to know what:\n" + charts());
  if (words[0] == "chart")
    if (const std::string meant =
            lattice::meant_name(words[1], {"methods", "limits", "field", "chain"});
        !meant.empty())
      throw UsageError(fmt::format("no chart '{}'; did you mean chart {}?", words[1], meant));
  std::string line = fmt::format("{} is now: gatewalk {}", old->first, old->second);
  for (std::size_t i = 1; i < words.size(); ++i) line += " " + shell_quoted(words[i]);
  throw UsageError(line);
}

/// Prints the page of a command, or of its result. `words`: the command's name, and --result.
int run_help(const std::vector<std::string>& words) {
  refuse_old_name(words);
  const std::size_t n = words_of_name(words);
  const std::string name = words[0] + (n == 2 ? " " + words[1] : "");
  const Command* const command = find_command(name, [](std::ostream& out) {
    out << "cli/site/glossary.md explains words; gatewalk help lists the commands.\n";
  });
  if (!command) return kWrongUse;
  if (words.size() == n) return command->run({"--help"});
  if (words.size() > n + 1 || words[n] != "--result")
    throw UsageError(fmt::format("help {} takes --result, and nothing else: not '{}'", name,
                                 words[words[n] == "--result" ? n + 1 : n]));
  for (const ResultOf& of : results())
    if (of.command == std::string_view(command->name)) {
      write_text_atomically("-", result_page(of));
      return kFine;
    }
  throw UsageError(name + " has no result of its own: it gives those of other commands, or files");
}

int run(const std::vector<std::string>& words) {
  if (words.empty()) {
    print_help(std::cerr);
    return kWrongUse;
  }
  if (words[0] == "help" && words.size() == 3 && words[1] == "--write") {
    write_help(words[2]);
    return kFine;
  }
  const std::vector<std::string> behind(words.begin() + 1, words.end());
  const bool of_charts = words[0] == "help" ? behind == std::vector<std::string>{"chart"}
                                            : words[0] == "chart" && words.size() == 2 &&
                                                  (words[1] == "--help" || words[1] == "-h");
  if (of_charts) {
    write_text_atomically("-", charts());
    return kFine;
  }
  if (words[0] == "help" && words.size() > 1 && words[1] != "help" && words[1] != "--help")
    return run_help(behind);
  if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
    lattice::TextStream text;
    print_help(text);
    write_text_atomically("-", text.str());
    return kFine;
  }
  if (words[0] == "--version" || words[0] == "-V") {
    const bool verbose = words.size() == 2 && words[1] == "--verbose";
    if (words.size() > 1 && !verbose) throw UsageError("--version takes --verbose alone");
    write_text_atomically("-", std::string("gatewalk ") + kVersion + " (" + kCommit + ")\n" +
                                   (verbose ? kBuiltWith : ""));
    return kFine;
  }
  refuse_old_name(words);
  const std::size_t n = words_of_name(words);
  const Command* const command = find_command(n == 2 ? words[0] + " " + words[1] : words[0]);
  const auto first = words.begin() + static_cast<std::ptrdiff_t>(n);
  return command ? command->run(std::vector(first, words.end())) : kWrongUse;
}

std::terminate_handler usual_end = nullptr;

/// Ends the program when no memory is left to build a message.
[[noreturn]] void end_without_memory() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    constexpr std::string_view kText =
        "gatewalk: out of memory; files that are written already are whole and stay\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText.data(), kText.size());
    _exit(kFailure);
  } catch (...) {
  }
  if (usual_end) usual_end();
  std::abort();
}

}  // namespace
}  // namespace gatewalk::cli

int main(int argc, char** argv) {
  using namespace gatewalk;
  cli::usual_end = std::set_terminate(cli::end_without_memory);
  cli::install_interrupt_handler();
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe must not end a run that writes files
  const cli::RanksScope scope;
  // Of several MPI processes only the first prints, except errors that occur in one process alone.
  std::streambuf* const err = std::cerr.rdbuf();
  if (!cli::is_first_rank()) {
    std::cerr.rdbuf(nullptr);
    std::cout.rdbuf(nullptr);
  }
  const auto fail = [&](cli::ExitCode code, const std::exception& e) {
    if (code == cli::kFailure) std::cerr.rdbuf(err);
    std::cerr << "gatewalk: " << e.what() << "\n";
    if (code == cli::kFailure && cli::stopped_status() != cli::kStopped)
      std::cerr << cli::stopped_text();
    if (code == cli::kFailure) cli::abort_ranks(code);
    return static_cast<int>(code);
  };
  try {
    const int status = cli::run({argv + 1, argv + argc});
    return status == cli::kFine && cli::reader_went_away() ? cli::kReaderWentAway : status;
  } catch (const cli::Interrupted&) {
    std::cerr << cli::stopped_text();
    return cli::stopped_status();
  } catch (const cli::PartDone& part) {
    std::cerr << "gatewalk: " << part.file
              << " is done; gatewalk merge makes one run of all parts\n";
    return cli::kFine;
  } catch (const markov::BrokenPipe&) {
    return cli::kReaderWentAway;
  } catch (const cli::UsageError& e) {
    return fail(cli::kWrongUse, e);
  } catch (const gatewalk::lattice::SceneError& e) {
    return fail(cli::kWrongUse, e);
  } catch (const markov::BadFile& e) {
    return fail(cli::kWrongUse, e);
  } catch (const std::invalid_argument& e) {
    return fail(cli::kWrongUse, e);
  } catch (const std::bad_alloc&) {
    return fail(cli::kFailure, std::runtime_error(cli::out_of_memory()));
  } catch (const std::exception& e) {
    return fail(cli::kFailure, e);
  }
}
