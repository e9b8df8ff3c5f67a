#include <algorithm>
#include <filesystem>
#include <sstream>

#include "cli/command.h"
#include "cli/render/report.h"
#include "cli/terminal/output.h"
#include "lattice/scene/scene_bins.h"

namespace gatewalk::cli {
namespace {

/// "0.25", or "(0, 1e+100]" with its unit, on a line of its own key.
std::string table_of(const std::vector<lattice::KeyInfo>& keys) {
  std::size_t key_width = 0, value_width = 0, unit_width = 0, source_width = 0;
  for (const lattice::KeyInfo& k : keys) {
    key_width = std::max(key_width, k.key.size());
    value_width = std::max(value_width, k.value.size());
    unit_width = std::max(unit_width, k.unit.size());
    source_width = std::max(source_width, k.source.size());
  }
  const auto column = [](const std::string& text, std::size_t width) {
    return padded(text, -static_cast<int>(width + 2));
  };
  std::string table = column("key", key_width) + column("value", value_width) +
                      column("unit", unit_width) + column("from", source_width) +
                      "meaning; range\n";
  for (const lattice::KeyInfo& k : keys)
    table += column(k.key, key_width) + column(k.value, value_width) + column(k.unit, unit_width) +
             column(k.source, source_width) + k.meaning + (k.range.empty() ? "" : "; " + k.range) +
             "\n";
  return table;
}

/// The scene as a file to edit: every key with its value, unit, range and meaning.
std::string commented(const std::vector<lattice::KeyInfo>& keys) {
  std::string text =
      "# A scene for gatewalk: one body, one gate with two beams, a field of such gates. Units are "
      "in the keys.\n"
      "# A key that is left out, as behind #, follows from the others by the paper's proportions: "
      "from body.radius_m,\n"
      "# body.mass_kg and forces.propulsion_N. gatewalk scene FILE shows every value and its "
      "source.\n";
  std::string table;
  std::size_t width = 0;
  const auto leaf = [](const lattice::KeyInfo& k) { return k.key.substr(k.key.find('.') + 1); };
  for (const lattice::KeyInfo& k : keys)
    width = std::max(width, leaf(k).size() + k.value.size() + 5);
  for (const lattice::KeyInfo& k : keys) {
    if (const std::string own = k.key.substr(0, k.key.find('.')); own != table)
      text += "\n[" + (table = own) + "]\n";
    const bool follows = k.source == "derived";
    text += padded((follows ? "# " : "") + leaf(k) + " = " + k.value, -static_cast<int>(width)) +
            "  # " + k.meaning;
    if (!k.range.empty()) text += ", in " + k.range + (k.unit.empty() ? "" : " " + k.unit);
    if (follows || k.source == "paper") text += "; " + k.source;
    text += "\n";
  }
  return text;
}

/// Overrides as lines of a file: without a file they are the scene, and the rest follows from them.
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

int run_scene(const std::vector<std::string>& arguments) {
  Options options(
      "scene [SCENE] [options]",
      "Shows every key of a scene: its value, unit, range and meaning, and where the value comes\n"
      "from: a line of the file, an override, the paper, or derived from the other keys. Without "
      "a\n"
      "file the scene is what --set gives.",
      "gatewalk scene --new --set body.mass_kg=0.25 --set body.radius_m=0.08 "
      "--set forces.propulsion_N=0.8 -o robot.toml");
  options.positional("scene", "scene file (TOML)", false);
  options.add()("new", "write the scene as a commented TOML file, to edit");
  options.output_file("output", "FILE", "with --new: the file to write (default: standard output)");
  if (!options.parse(arguments)) return kFine;
  if (options.has("output") && !options.has("new"))
    throw UsageError("--output has no meaning without --new");
  const std::string file = options.text("output");
  if (!file.empty() && file != "-" && std::filesystem::is_regular_file(file))
    throw UsageError("--output " + file +
                     ": is there already, and may hold a scene of yours; name another file");
  const lattice::Scene scene = options.has("scene")
                                   ? lattice::read_scene(options.text("scene"), options.overrides())
                                   : lattice::parse_scene(as_text(options.overrides()), "--set");
  const std::vector<lattice::KeyInfo> keys = lattice::describe(scene);
  if (options.has("new")) {
    if (options.has("json")) throw UsageError("--json has no meaning beside --new");
    std::string text = commented(keys);
    if (scene.bins) text += "\n" + lattice::bins_toml(*scene.bins);
    if (!scene.sweep.empty()) text += "\n[sweep]\n";
    for (const lattice::Variation& v : scene.sweep)
      text += "\"" + v.key + "\" = \"" + v.values + "\"\n";
    write_text_atomically(file.empty() ? "-" : file, text);
    return kFine;
  }
  Json json;
  for (const lattice::KeyInfo& k : keys)
    json["keys"].push_back({{"key", k.key},
                            {"value", k.value},
                            {"unit", k.unit},
                            {"range", k.range},
                            {"meaning", k.meaning},
                            {"source", k.source}});
  json["scene"] = lattice::to_toml(scene);
  options.give_out(json, table_of(keys));
  return kFine;
}

}  // namespace gatewalk::cli
