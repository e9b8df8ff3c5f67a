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
                  "Reproduces the paper. gatewalk runs the studies behind the paper's figures, "
                  "tables and numbers,\n"
                  "compares each claim with the result, with a 95 % interval and a verdict, and "
                  "writes every figure\n"
                  "as CSV, SVG and PDF. The page DIR/report.html shows all of them and needs no "
                  "network. If a run\n"
                  "is stopped, the same command continues it.",
                  "gatewalk reproduce -o paper --quick");
  options.without_scene("the studies have scenes of their own, written to DIR/scenes");
  options.output_folder("folder to write to", {"report.html", "report.json", "claims.csv"});
  const Option quick =
      options.add_flag("quick", "fewer trials: half a minute on two cores instead of four");
  options.add_details("all claims, and how long each study took");
  options.most_used({"output", "quick"});
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.output.value();
  if (options.json && options.json.value() != "-")
    throw UsageError("--json takes only - here: DIR/report.json is written anyway");
  try {
    const Report r = reproduce({.folder = folder,
                                .quick = static_cast<bool>(quick),
                                .talk = options.talk(),
                                .each = static_cast<bool>(options.details),
                                .force = static_cast<bool>(options.force)});
    options.give_out(
        r,
        options.talk()
            ? Screen(fmt::format("{} claims of the paper: {}.\n", r.claims.size(), r.tally()) +
                         summary_of(r.claims) +
                         fmt::format("{}/report.{} says why a claim differs.\n", folder,
                                     has_pages() ? "html" : "json"),
                     "\n" + table_of(r.claims) +
                         fmt::format("The studies took {} s.\n", fixed(r.made_by.seconds, 0)))
            : Screen(""),
        -1);
  } catch (const Interrupted&) {
    std::cerr << "gatewalk: stopped before the end; what was finished stays in " << folder
              << ", the same command goes on from there\n";
    return kStopped;
  }
  return kFine;
}

}  // namespace gatewalk::cli
