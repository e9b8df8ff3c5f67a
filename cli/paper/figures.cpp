// SPDX-License-Identifier: MIT
#include "cli/paper/figures.h"

#include "cli/terminal/gnuplot.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {

std::vector<Report::Section> sections_of(const Findings& f,
                                         const std::map<std::string, std::string>& commands) {
  std::vector<Report::Section> list;
  for (const Section& s : {fig5(), barriers(f), fig6(f), fig8(f), fig9(f), thirteen_eight(f),
                           fig12(f), fig11(f), table4(f), crossings(f), speed(f), replay(f)}) {
    if (interrupted()) throw Interrupted{};
    Report::Section section{s.id, s.heading, s.text, s.alt, {}, {}, s.film};
    std::string made_by = "gatewalk reproduce";
    for (const std::string& study : s.studies)
      if (const auto found = commands.find(study); found != commands.end()) {
        made_by += (section.commands.empty() ? ": " : "; ") + found->second;
        section.commands.push_back(found->second);
      }
    if (s.film.is_null()) {
      write_text_atomically(section.id + ".csv", s.csv);
      for (const char* end : {".svg", ".pdf"})
        draw(section.id + end, s.figure, {s.heading, made_by});
      for (const char* end : {".csv", ".svg", ".pdf"}) section.files.push_back(section.id + end);
    }
    list.push_back(std::move(section));
  }
  return list;
}

}  // namespace gatewalk::cli
