// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <iostream>

#include "cli/command.h"
#include "cli/fields/text.h"
#include "cli/paper/reproduction.h"
#include "cli/terminal/interrupt.h"
#include "cli/web/embedded.h"

namespace gatewalk::cli {

int run_reproduce(const Arguments& arguments) {
  Options options("reproduce -o DIR [options]",
                  "Everything of the paper: runs the studies behind its figures, tables and "
                  "numbers, sets each claim beside\n"
                  "what was found, with intervals and a verdict, and writes CSV, SVG and PDF of "
                  "every figure and one page,\n"
                  "report.html, that needs no network. A run that was stopped goes on where it was "
                  "when started again.",
                  "gatewalk reproduce -o paper --quick");
  options.without_scene("the studies have scenes of their own, written to DIR/scenes");
  options.output_folder("folder to write to", {"report.html", "report.json", "claims.csv"});
  const Option quick =
      options.add_flag("quick", "fewer trials: half a minute on two cores instead of four");
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.output.value();
  if (options.json && options.json.value() != "-")
    throw UsageError("--json takes only - here: DIR/report.json is written anyway");
  try {
    const Report r = reproduce({.folder = folder,
                                .quick = static_cast<bool>(quick),
                                .talk = options.talk(),
                                .force = static_cast<bool>(options.force)});
    options.give_out(r,
                     options.talk()
                         ? fmt::format("\n{}\n{}. Studies {} s. Open {}/report.{}\n",
                                       table_of(r.claims), r.tally(), fixed(r.made_by.seconds, 0),
                                       folder, has_pages() ? "html" : "json")
                         : "",
                     -1);
  } catch (const Interrupted&) {
    std::cerr << "gatewalk: stopped before the end; what was finished stays in " << folder
              << ", the same command goes on from there\n";
    return kStopped;
  }
  return kFine;
}

}  // namespace gatewalk::cli
