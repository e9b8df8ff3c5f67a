// SPDX-License-Identifier: MIT
#include "cli/paper/figures.h"

#include "cli/terminal/gnuplot.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {

Json sections_of(const Findings& f, const std::map<std::string, std::string>& commands) {
  Json list = Json::array();
  for (const Section& s : {fig5(), barriers(f), fig6(f), fig8(f), fig9(f), thirteen_eight(f),
                           fig12(f), fig11(f), table4(f), crossings(f), speed(f), replay(f)}) {
    if (interrupted()) throw Interrupted{};
    Json used = Json::array(), files = Json::array();
    std::string made_by = "gatewalk reproduce";
    for (const std::string& study : s.studies)
      if (const auto found = commands.find(study); found != commands.end()) {
        made_by += (used.empty() ? ": " : "; ") + found->second;
        used.push_back(found->second);
      }
    const std::string name = s.id;
    if (s.film.is_null()) {
      write_text_atomically(name + ".csv", s.csv);
      for (const char* end : {".svg", ".pdf"}) draw(name + end, s.figure, {s.heading, made_by});
      for (const char* end : {".csv", ".svg", ".pdf"}) files.push_back(name + end);
    }
    Json section{{"id", name},   {"heading", s.heading}, {"text", s.text},
                 {"alt", s.alt}, {"commands", used},     {"files", files}};
    if (!s.film.is_null()) section["film"] = s.film;
    list.push_back(std::move(section));
  }
  return list;
}

}  // namespace gatewalk::cli
