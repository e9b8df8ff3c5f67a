// SPDX-License-Identifier: MIT
#include "cli/paper/page.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>
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
constexpr std::array<Mark, 4> kMarks = {{{kVerdictNames[3], "differs", "≠"},
                                         {kVerdictNames[2], "unknown", "?"},
                                         {kVerdictNames[1], "agrees", "≈"},
                                         {kVerdictNames[0], "reproduced", "✓"}}};

const Mark& mark_of(const Json& claim) {
  const auto name = claim.at("verdict").get<std::string>();
  for (const Mark& m : kMarks) {
    if (name == m.name) return m;
  }
  throw std::invalid_argument("claim " + claim.at("id").get<std::string>() +
                              ": unknown verdict \"" + name + "\"");
}

/// Whether a word is a quantity with an index as the paper prints it: k_L, F_prop.
bool has_index(std::string_view word) {
  constexpr std::array<std::string_view, 6> kIndices = {"L", "R", "x", "y", "prop", "rand"};
  return word.size() > 2 && std::string_view("kFivE").find(word[0]) != std::string_view::npos &&
         word[1] == '_' &&
         std::find(kIndices.begin(), kIndices.end(), word.substr(2)) != kIndices.end();
}

/// Words as they stand in HTML; an index as the paper prints it: k_L as k<sub>L</sub>.
std::string words(const std::string& plain) {
  const auto in_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  const std::string html = escaped(plain);
  std::string out;
  for (auto at = html.begin(); at != html.end();) {
    const auto end = std::find_if_not(at, html.end(), in_word);
    const std::string word(at, end);
    out += has_index(word) ? word.substr(0, 1) + "<sub>" + word.substr(2) + "</sub>" : word;
    if (end == html.end()) break;
    out += *end;
    at = end + 1;
  }
  return out;
}

/// A text field as words.
std::string text(const Json& object, const char* field) {
  return words(object.at(field).get<std::string>());
}

/// The same, with nothing broken apart at a line's end that belongs together: "46.0 % [45.3, 46.7]"
/// between % and [ only.
std::string values(const Json& object, const char* field) {
  std::string out;
  const std::string all = text(object, field);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t bracket = all.find_first_of("[]", i);
    const bool inside = bracket != std::string::npos && all[bracket] == ']';
    const bool before_percent = i + 1 < all.size() && all[i + 1] == '%';
    if (all[i] == ' ' && (inside || before_percent))
      out += "&nbsp;";
    else
      out += all[i];
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
  for (const Json& p : list) out += element("p", words(p.get<std::string>()));
  return out;
}

std::string badge(const Mark& v) {
  return element(std::string("span class=\"badge ") + v.style + "\"",
                 std::string("<i aria-hidden=\"true\">") + v.symbol + "</i>" + std::string(v.name));
}

std::int64_t count(const Json& claims, const Mark& mark) {
  return std::count_if(claims.begin(), claims.end(),
                       [&](const Json& c) { return &mark_of(c) == &mark; });
}

/// How many claims got each verdict, as a bar.
std::string tally_of(const Json& claims) {
  std::string bar;
  for (const Mark& v : kMarks)
    if (const auto n = count(claims, v); n > 0)
      bar += "<span class=\"" + std::string(v.style) + "\" style=\"flex-grow:" + std::to_string(n) +
             "\"></span>";
  return element("div class=\"bar\" aria-hidden=\"true\"", bar);
}

/// Buttons that leave the claims of one verdict (report.css does it).
std::string filter_of(const Json& claims) {
  const auto button = [](const std::string& id, const std::string& label, bool checked) {
    return element("label", "<input type=\"radio\" name=\"verdict\" id=\"show-" + id + "\"" +
                                (checked ? " checked" : "") + ">" + element("span", label));
  };
  std::string out = button("all", "all " + std::to_string(claims.size()), true);
  for (const Mark& v : kMarks)
    if (const auto n = count(claims, v); n > 0)
      out += button(v.style,
                    std::string(v.symbol) + " " + std::string(v.name) + " " + std::to_string(n),
                    false);
  return out;
}

/// Every claim, folded, those that differ first.
std::string folded(const Json& claims, const std::map<std::string, std::string>& headings) {
  std::string out;
  for (const Mark& v : kMarks)
    for (const Json& c : claims) {
      if (&mark_of(c) != &v) continue;
      const auto see = c.at("see").get<std::string>();
      const auto heading = headings.find(see);
      if (heading == headings.end())
        throw std::invalid_argument("claim " + c.at("id").get<std::string>() + ": no section \"" +
                                    see + "\"");
      const auto entry = [](const char* name, const std::string& value) {
        return element("div", element("dt", name) + element("dd", value));
      };
      std::string about = entry("Paper", values(c, "paper")) + entry("Here", values(c, "ours"));
      if (!c.at("why").get<std::string>().empty()) about += entry("Remark", text(c, "why"));
      about += entry("Where", text(c, "where") + "; here: <a href=\"#" + escaped(see) + "\">" +
                                  words(heading->second) + "</a>");
      out += element(
          "details class=\"claim " + std::string(v.style) + "\" id=\"claim-" + text(c, "id") + "\"",
          element("summary", badge(v) + element("span", text(c, "claim"))) + element("dl", about));
    }
  return out;
}

/// A picture as it stands in an attribute: the whole file, nothing to be fetched.
std::string picture(const std::string& svg, const std::string& alt) {
  std::string url = "data:image/svg+xml,";
  for (const char c : svg) switch (c) {
      case '%':
        url += "%25";
        break;
      case '#':
        url += "%23";
        break;
      case '\n':
        url += "%0A";
        break;
      case '\t':
        url += ' ';
        break;
      default:
        url += escaped({&c, 1});
    }
  return "<img src=\"" + url + "\" alt=\"" + escaped(alt) + "\">";
}

/// A command whose words stay whole where a line ends.
std::string command(const std::string& line) {
  std::string out;
  std::istringstream in(line);
  for (std::string word; in >> word;)
    out += (out.empty() ? "<span>" : " <span>") + escaped(word) + "</span>";
  return element("code", out);
}

/// The picture of a section or of the page's beginning, with what made it.
std::string figure(const Json& about, const std::string& file, const std::string& caption,
                   const FigureText& figure_text) {
  const auto alt = about.at("alt").get<std::string>();
  return element("figure",
                 element("a href=\"" + escaped(file) + "\"", picture(figure_text(file), alt)) +
                     element("figcaption", caption));
}

std::string first_screen(const Json& first, const FigureText& figure_text) {
  std::string out;
  for (const Json& f : first)
    out += figure(f, f.at("figure").get<std::string>(),
                  element("p", text(f, "caption")) +
                      element("div class=\"commands\"", command(f.at("command"))),
                  figure_text);
  return out;
}

/// What made a section, and its files.
std::string made_with(const Json& s) {
  std::string commands, files;
  for (const Json& c : s.at("commands")) commands += command(c);
  for (const Json& f : s.at("files")) {
    const std::string name = escaped(f.get<std::string>());
    files += "<a href=\"" + name + "\">" + name + "</a> ";
  }
  const auto n = s.at("commands").size();
  if (n > 0) commands = element("div class=\"commands\"", commands);
  if (n > 2)
    commands = element("details", element("summary", std::to_string(n) + " commands") + commands);
  return commands + (files.empty() ? "" : element("p class=\"files\"", "Files: " + files));
}

std::string section(const Json& s, const Json& claims, const FigureText& figure_text) {
  const auto id = s.at("id").get<std::string>();
  std::string about;
  for (const Json& c : claims)
    if (c.at("see").get<std::string>() == id)
      about += element("li", "<a href=\"#claim-" + text(c, "id") + "\">" + badge(mark_of(c)) +
                                 element("span", text(c, "claim")) + "</a>");
  if (!about.empty()) about = element("ul class=\"about\" aria-label=\"Claims shown here\"", about);
  const std::string head = element("h2", text(s, "heading")),
                    words = element("div class=\"text\"", paragraphs(s.at("text")) + about);
  const bool plays = s.contains("film");
  const std::string shown =
      plays ? "<figure><div class=\"replay\"><noscript><p>The animation needs JavaScript. " +
                  text(s, "alt") +
                  "</p></noscript></div>\n<script type=\"application/json\" id=\"film\">" +
                  script_json(s.at("film")) + "</script>" + element("figcaption", made_with(s)) +
                  "</figure>\n"
            : figure(s, id + ".svg", made_with(s), figure_text);
  return element("section id=\"" + escaped(id) + "\"" + (plays ? " class=\"wide\"" : ""),
                 head + element("div class=\"beside\"", shown + words));
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
                entry("Command", command(made.at("command"))) +
                entry("Seed", made.at("seed").dump()) + entry("Machine", text(made, "machine")) +
                entry("Time taken", duration(made.at("seconds").get<double>())) +
                entry("Date", text(made, "date")));
  for (const Json& scene : made.at("scenes")) {
    out += element("details", element("summary", text(scene, "name")) +
                                  element("pre tabindex=\"0\"", text(scene, "text")));
  }
  return out;
}

}  // namespace

std::string report_page(const Json& report, const FigureText& figure_text) {
  const Json& claims = report.at("claims");
  std::map<std::string, std::string> headings;
  std::string contents, sections;
  for (const Json& s : report.at("sections")) {
    const auto id = s.at("id").get<std::string>();
    const auto heading = s.at("heading").get<std::string>();
    // "Fig. 8: traversal of ..." is "Fig. 8" where room is short.
    if (!headings.emplace(id, heading.substr(0, heading.find(':'))).second)
      throw std::invalid_argument("two sections \"" + id + "\"");
    contents += element("li", "<a href=\"#" + escaped(id) + "\">" + words(heading) + "</a>");
    sections += section(s, claims, figure_text);
  }
  return filled(carried_file("report.html"),
                {{"title", text(report, "title")},
                 {"paper", text(report, "paper")},
                 {"css", std::string(carried_file("report.css"))},
                 {"first", first_screen(report.at("first"), figure_text)},
                 {"lead", paragraphs(report.at("lead"))},
                 {"tally", tally_of(claims)},
                 {"filter", filter_of(claims)},
                 {"claims", folded(claims, headings)},
                 {"contents", contents},
                 {"sections", sections},
                 {"made_by", made_by(report.at("made_by"))},
                 {"replay", std::string(carried_file("replay.js"))},
                 {"theme", std::string(carried_file("theme.js"))},
                 {"js", std::string(carried_file("report.js"))}});
}

}  // namespace gatewalk::cli
