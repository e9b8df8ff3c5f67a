// SPDX-License-Identifier: MIT
// make_replays FOLDER: the replay pages that replay_test.mjs looks at.

#include <iostream>

#include "cli/film/replay.h"
#include "cli/render/json_value.h"
#include "cli/terminal/output.h"
#include "tests/cli/films.h"

int main(int argc, char** argv) try {
  using namespace gatewalk::cli;
  if (argc != 2) throw std::invalid_argument("make_replays FOLDER");
  const auto write = [&](const char* name, const Json& film) {
    write_text_atomically(std::string(argv[1]) + "/" + name, replay_page(film));
  };
  Json film = to_json(small_film(100));
  write("gate-one.html", film);
  film["runs"].push_back(film["runs"][0]);
  film["runs"][1]["label"] = "trial 2: </script><b>trapped</b>";
  film["runs"][1]["ending"] = "trapped";
  write("gate.html", film);
  write("field.html", to_json(small_field_film()));
  Film film_of_two = small_mixed_film();
  const Json mixed = to_json(film_of_two);
  write("mixed.html", mixed);
  film_of_two.actions = {"gently", "hard"};  // of one type of gate
  write("chosen.html", to_json(film_of_two));
  film_of_two.actions.push_back("sideways");
  write("short-of-actions.html", to_json(film_of_two));
  Json short_of_types = mixed;
  short_of_types["types"].erase(1);
  short_of_types["types"][0]["beam_m"] = -1.0;
  write("short-of-types.html", short_of_types);
  int number = 0;
  for (const auto& twin : kOtherUnits) {
    const auto name = [&](const char* of) { return of + std::to_string(number) + ".html"; };
    write(name("gate-twin-").c_str(), to_json(in_other_units(small_film(100), twin)));
    write(name("field-twin-").c_str(), to_json(in_other_units(small_field_film(), twin)));
    ++number;
  }
  Json broken = to_json(small_film(5));
  broken["runs"][0].erase("left");
  broken["runs"][0]["vy"][2] = nullptr;
  broken["runs"][0]["contact_right"].push_back(0);
  write("broken.html", broken);
  Json unknown = to_json(small_film(5));
  unknown["runs"][0]["heat_J"] = Json::array();
  write("unknown.html", unknown);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
