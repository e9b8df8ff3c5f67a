#include "cli/paper/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>

#include "cli/paper/verdicts.h"
#include "cli/render/json.h"
#include "cli/render/text.h"
#include "cli/web/embedded.h"
#include "cli/web/html.h"

namespace gatewalk::cli {
namespace {

/// How a verdict is shown: never by colour alone.
struct Mark {
  std::string_view name;
  const char *style, *symbol;
};
constexpr std::array<Mark, 3> kMarks = {{{kVerdictNames[0], "reproduced", "✓"},
                                         {kVerdictNames[1], "noise", "≈"},
                                         {kVerdictNames[2], "differs", "≠"}}};

const Mark& mark_of(const Json& claim) {
  const auto name = claim.at("verdict").get<std::string>();
  for (const Mark& m : kMarks) {
    if (name == m.name) return m;
  }
  throw std::invalid_argument("claim " + claim.at("id").get<std::string>() +
                              ": unknown verdict \"" + name + "\"");
}

/// A text field, ready for HTML.
std::string text(const Json& object, const char* field) {
  return escaped(object.at(field).get<std::string>());
}

/// The same, with nothing broken apart at a line's end that belongs together: "46.0 % [45.3, 46.7]"
/// between % and [ only.
std::string values(const Json& object, const char* field) {
  const auto plain = object.at(field).get<std::string>();
  std::string out;
  bool in_brackets = false;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    in_brackets = (in_brackets || plain[i] == '[') && plain[i] != ']';
    const bool kept = in_brackets || plain.compare(i, 2, " %") == 0;
    out += plain[i] == ' ' && kept ? "&nbsp;" : escaped(plain.substr(i, 1));
  }
  return out;
}

/// An element that closes itself: <p class="why">...</p> from element("p class=\"why\"", ...).
std::string element(std::string_view opening, const std::string& inside) {
  const std::string_view name = opening.substr(0, opening.find(' '));
  return "<" + std::string(opening) + ">" + inside + "</" + std::string(name) + ">\n";
}

std::string paragraphs(const Json& list) {
  std::string out;
  for (const Json& p : list) out += element("p", escaped(p.get<std::string>()));
  return out;
}

std::string badge(const Mark& v) {
  return element(std::string("span class=\"badge ") + v.style + "\"",
                 std::string("<i aria-hidden=\"true\">") + v.symbol + "</i>" + std::string(v.name));
}

/// How many claims got each verdict, as a bar and in numbers.
std::string tally_of(const Json& claims) {
  std::string bar, list;
  for (const Mark& v : kMarks) {
    const auto n = std::count_if(claims.begin(), claims.end(),
                                 [&](const Json& c) { return &mark_of(c) == &v; });
    if (n == 0) continue;
    bar += "<span class=\"" + std::string(v.style) + "\" style=\"flex-grow:" + std::to_string(n) +
           "\"></span>";
    list += element(std::string("li class=\"") + v.style + "\"",
                    "<b>" + std::to_string(n) + "</b>" + badge(v));
  }
  return element("div class=\"bar\" aria-hidden=\"true\"", bar) + element("ul", list);
}

std::string claim_rows(const Json& claims, const std::map<std::string, std::string>& headings) {
  std::string rows;
  for (const Json& c : claims) {
    const Mark& v = mark_of(c);
    const auto see = c.at("see").get<std::string>();
    const auto heading = headings.find(see);
    if (heading == headings.end()) {
      throw std::invalid_argument("claim " + c.at("id").get<std::string>() + ": no section \"" +
                                  see + "\"");
    }
    std::string what =
        element("span class=\"where\"", text(c, "where")) + element("p", text(c, "claim"));
    if (!c.at("why").get<std::string>().empty()) what += element("p class=\"why\"", text(c, "why"));
    const std::string cell = "td role=\"cell\" ";
    rows += element(
        "tr role=\"row\" class=\"" + std::string(v.style) + "\" id=\"claim-" + text(c, "id") + "\"",
        element(cell + "class=\"claim\"", what) +
            element(cell + "data-label=\"Paper\"", values(c, "paper")) +
            element(cell + "data-label=\"Here\"", values(c, "ours")) +
            element(cell + "data-label=\"Verdict\"", badge(v)) +
            element(cell + "data-label=\"See\"",
                    "<a href=\"#" + escaped(see) + "\">" + escaped(heading->second) + "</a>"));
  }
  return rows;
}

std::string section(const Json& s, const Json& claims) {
  const auto id = s.at("id").get<std::string>();
  std::string about, commands, files;
  for (const Json& c : claims) {
    if (c.at("see").get<std::string>() != id) continue;
    about += element("li", "<a href=\"#claim-" + text(c, "id") + "\">" + badge(mark_of(c)) +
                               text(c, "claim") + "</a>");
  }
  for (const Json& c : s.at("commands")) commands += element("code", escaped(c.get<std::string>()));
  for (const Json& f : s.at("files")) {
    const std::string name = escaped(f.get<std::string>());
    files += "<a href=\"" + name + "\">" + name + "</a> ";
  }
  std::string out = element("h2", text(s, "heading"));
  if (!about.empty()) out += element("ul class=\"about\" aria-label=\"Claims shown here\"", about);
  out += element("div class=\"text\"", paragraphs(s.at("text")));
  out += "<figure>";
  if (s.contains("film"))
    out += element("div class=\"chart\" data-kind=\"replay\" data-section=\"" + escaped(id) +
                       "\" data-alt=\"" + text(s, "alt") + "\"",
                   "<noscript><p class=\"remark\">" + text(s, "alt") + "</p></noscript>");
  else
    out += "<img src=\"" + escaped(id) + ".svg\" alt=\"" + text(s, "alt") + "\">\n";
  std::string how;
  const auto n = s.at("commands").size();
  if (n > 0) commands = element("div class=\"commands\"", commands);
  how += n > 3 ? element("details", element("summary", std::to_string(n) + " commands") + commands)
               : commands;
  if (!files.empty()) how += element("p class=\"files\"", "Files: " + files);
  out += element("figcaption", how) + "</figure>\n";
  return element("section id=\"" + escaped(id) + "\"", out);
}

std::string duration(double seconds) {
  if (seconds < 120) return fixed(seconds, seconds < 10 ? 1 : 0) + " s";
  const auto whole = std::llround(seconds);
  if (whole < 7200) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

std::string made_by(const Json& made) {
  const auto entry = [](const char* name, const std::string& value) {
    return element("div", element("dt", name) + element("dd", value));
  };
  std::string out = element(
      "dl", entry("Program", text(made, "program")) +
                entry("Command", "<code>" + text(made, "command") + "</code>") +
                entry("Seed", made.at("seed").dump()) + entry("Machine", text(made, "machine")) +
                entry("Time taken", duration(made.at("seconds").get<double>())) +
                entry("Date", text(made, "date")));
  for (const Json& scene : made.at("scenes")) {
    out += element("details", element("summary", text(scene, "name")) +
                                  element("pre tabindex=\"0\"", text(scene, "text")));
  }
  return out;
}

std::string licences() {
  std::string out;
  for (const char* name :
       {"vega.LICENSE", "vega-lite.LICENSE", "vega-embed.LICENSE", "plotly.LICENSE"}) {
    out += element("h3", name) + element("pre tabindex=\"0\"", escaped(carried_file(name)));
  }
  return out;
}

/// A script for report.js to start when it is needed, so that the page opens at once.
std::string library(const char* name) {
  const std::string code(carried_file(name));
  if (code.find("</script") != std::string::npos)
    throw std::logic_error(std::string(name) + " cannot stand in a page");
  return element("script type=\"text/plain\" id=\"" + std::string(name) + "\"", code);
}

}  // namespace

std::string report_page(const Json& report) {
  const Json& claims = report.at("claims");
  std::map<std::string, std::string> headings;
  std::string contents, sections;
  Json data = Json::object();
  for (const Json& s : report.at("sections")) {
    const auto id = s.at("id").get<std::string>();
    const auto heading = s.at("heading").get<std::string>();
    // "Fig. 8: traversal of ..." is "Fig. 8" where room is short.
    if (!headings.emplace(id, heading.substr(0, heading.find(':'))).second) {
      throw std::invalid_argument("two sections \"" + id + "\"");
    }
    contents += element("li", "<a href=\"#" + escaped(id) + "\">" + escaped(heading) + "</a>");
    sections += section(s, claims);
    if (s.contains("film")) data[id] = {{"film", s.at("film")}};
  }

  return filled(carried_file("report.html"),
                {{"title", text(report, "title")},
                 {"paper", text(report, "paper")},
                 {"css", std::string(carried_file("report.css"))},
                 {"lead", paragraphs(report.at("lead"))},
                 {"tally", tally_of(claims)},
                 {"claims", claim_rows(claims, headings)},
                 {"contents", contents},
                 {"sections", sections},
                 {"made_by", made_by(report.at("made_by"))},
                 {"licences", licences()},
                 {"data", script_json(data)},
                 {"libraries", library("vega.min.js") + library("vega-lite.min.js") +
                                   library("vega-embed.min.js") + library("plotly-gl3d.min.js")},
                 {"replay", std::string(carried_file("replay.js"))},
                 {"js", std::string(carried_file("report.js"))}});
}

}  // namespace gatewalk::cli
