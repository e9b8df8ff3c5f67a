// SPDX-License-Identifier: MIT
#include "cli/render/scene.h"
#include "cli/next.h"
#include "cli/render/meaning.h"
#include "cli/source_options.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {
namespace {

/// The overrides as lines of a scene file. Without a file these lines are the scene, from which the
/// other keys follow.
std::string as_text(const std::vector<std::string>& overrides) {
  std::string text;
  for (const std::string& given : overrides) {
    const std::size_t value = given.find('=') + 1;
    const bool bare = (given.starts_with("run.method") || given.starts_with("field.fidelity")) &&
                      value > 0 && given.find_first_of("\"'") == given.npos;
    text += bare ? given.substr(0, value) + "\"" + given.substr(value) + "\"\n" : given + "\n";
  }
  return text;
}

}  // namespace

int run_scene(const Arguments& arguments) {
  Options options(
      "scene [SCENE] [options]",
      "Shows what a scene means in words, and every key with its value, unit, range and source: a "
      "line of\n"
      "the file, --set, the paper (a default), or derived from the other keys. scene also says "
      "which\n"
      "numbers are unusual for walking animals and robots. Without a file, the scene is what --set "
      "gives.",
      "gatewalk scene --new --set body.mass_g=250 --set body.radius_cm=8 -o mine.toml");
  const TextOption given =
      options.positional("scene", "scene file (TOML; -: standard input)", false);
  const Option is_new =
      options.add_flag("new", "write the scene as a TOML file with comments, to edit");
  const TextOption output = options.output_file(
      "output", "FILE", "with --new: the file to write (default: standard output)");
  options.most_used({"set", "new", "output", "figure", "json"});
  options.add_figure("one gate to scale, each length and force at its place");
  if (!options.parse(arguments)) return kFine;
  if (!is_new) refuse({output}, "without --new");
  const lattice::Scene scene =
      given ? options.read_scene() : lattice::parse_scene(as_text(options.overrides()), "--set");
  if (is_new) {
    refuse({options.json, options.figure}, "beside --new");
    options.write(output ? output.value() : "-", commented(scene));
    return kFine;
  }
  const SceneResult result{scene, dynamics::meaning_of(scene.gate, scene.start),
                           dynamics::deciding_numbers(scene.gate, scene.start)};
  NextCommands next(options);
  if (given) next.add("predict", "", "predicts how bodies cross the field");
  next.again("figure", "gate.svg", "draws one gate to scale");
  options.give_out(result, {table_of(result), "", next.lines()});
  options.draw([&] { return figure_of(scene); });
  return kFine;
}

}  // namespace gatewalk::cli
