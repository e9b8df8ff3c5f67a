#include "cli/film/replay.h"

#include "cli/web/embedded.h"
#include "cli/web/html.h"

namespace gatewalk::cli {

std::string replay_page(const Json& film) {
  // Without scripts the page still says how the runs ended.
  std::string words;
  if (film.contains("runs"))
    for (const Json& run : film["runs"])
      words += "<p>" + escaped(run.value("label", "a run")) + "</p>";
  return filled(carried_file("replay.html"), {{"title", escaped(film.value("title", "Replay"))},
                                              {"words", words},
                                              {"script", std::string(carried_file("replay.js"))},
                                              {"film", script_json(film)}});
}

}  // namespace gatewalk::cli
