// SPDX-License-Identifier: MIT
// make_replays FOLDER: the replay pages that replay_test.mjs looks at.

#include <iostream>

#include "cli/terminal/output.h"
#include "cli/web/html.h"
#include "tests/cli/films.h"

int main(int argc, char** argv) try {
  using namespace gatewalk::cli;
  if (argc != 2) throw std::invalid_argument("make_replays FOLDER");
  const auto write = [&](const std::string& name, const std::string& page) {
    write_text_atomically(std::string(argv[1]) + "/" + name, page);
  };
  // Writes the page of a film with JSON in its place that is not a film's.
  const auto write_other = [&](const std::string& name, const Film& film, const Json& other) {
    std::string page = replay_page(film);
    const std::string own = script_json(text_of(json_of(film), -1));
    write(name, page.replace(page.find(own), own.size(), script_json(text_of(other, -1))));
  };
  Film film = small_film(100);
  write("gate-one.html", replay_page(film));
  film.runs.push_back(film.runs[0]);
  film.runs[1].label = "trial 2: </script><b>trapped</b>";
  film.runs[1].ending = "trapped";
  write("gate.html", replay_page(film));
  write("field.html", replay_page(small_field_film()));
  Film mixed = small_mixed_film();
  write("mixed.html", replay_page(mixed));
  Json short_of_types = json_of(mixed);
  short_of_types["types"].erase(1);
  short_of_types["types"][0]["beam_m"] = -1.0;
  write_other("short-of-types.html", mixed, short_of_types);
  mixed.actions = {"gently", "hard"};  // of one type of gate
  write("chosen.html", replay_page(mixed));
  mixed.actions.push_back("sideways");
  write("short-of-actions.html", replay_page(mixed));
  int number = 0;
  for (const auto& twin : kOtherUnits) {
    const auto name = [&](const char* of) { return of + std::to_string(number) + ".html"; };
    write(name("gate-twin-"), replay_page(in_other_units(small_film(100), twin)));
    write(name("field-twin-"), replay_page(in_other_units(small_field_film(), twin)));
    ++number;
  }
  const Film five = small_film(5);
  Json broken = json_of(five);
  broken["runs"][0].erase("left");
  broken["runs"][0]["vy"][2] = nullptr;
  broken["runs"][0]["contact_right"].push_back(0);
  write_other("broken.html", five, broken);
  Json unknown = json_of(five);
  unknown["runs"][0]["heat_J"] = Json::array();
  write_other("unknown.html", five, unknown);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
