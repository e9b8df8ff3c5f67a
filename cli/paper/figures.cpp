#include "cli/paper/figures.h"

#include "cli/terminal/interrupt.h"

namespace gatewalk::cli {

Json sections_of(const Findings& f, const std::map<std::string, std::string>& commands) {
  Json list = Json::array();
  for (const Section& s : {fig5(), barriers(f), fig6(f), fig8(f), fig9(f), thirteen_eight(f),
                           fig12(f), fig11(f), table4(f), crossings(f), speed(f), replay(f)}) {
    if (interrupted()) throw Interrupted{};
    Json used = Json::array(), files = Json::array();
    for (const std::string& study : s.studies)
      if (const auto found = commands.find(study); found != commands.end())
        used.push_back(found->second);
    if (s.drawn)
      for (const char* end : {".csv", ".svg", ".pdf"}) files.push_back(std::string(s.id) + end);
    Json section = {{"id", s.id},   {"heading", s.heading}, {"text", s.text},
                    {"alt", s.alt}, {"commands", used},     {"files", files}};
    if (s.data.contains("film")) section["film"] = s.data["film"];
    list.push_back(section);
  }
  return list;
}

}  // namespace gatewalk::cli
