// SPDX-License-Identifier: MIT
#include "cli/paper/page.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "cli/fields/json_value.h"
#include "cli/fields/text.h"
#include "cli/web/embedded.h"
#include "cli/web/html.h"

namespace gatewalk::cli {
namespace {

/// How a verdict is shown: never by colour alone.
struct Mark {
  const char *style, *symbol;
};
constexpr std::array<Mark, 4> kMarks = {
    {{"reproduced", "✓"}, {"agrees", "≈"}, {"unknown", "?"}, {"differs", "≠"}}};
/// Order of the verdicts on the page: claims that differ come first.
constexpr std::array kOrder{Verdict::differs, Verdict::cannot_tell, Verdict::agrees,
                            Verdict::reproduced};
Mark mark_of(Verdict v) { return kMarks[static_cast<std::size_t>(v)]; }

/// Whether a word is a quantity with an index, as k_L or F_prop.
bool has_index(std::string_view word) {
  constexpr std::array<std::string_view, 6> kIndices = {"L", "R", "x", "y", "prop", "rand"};
  return word.size() > 2 && std::string_view("kFivE").find(word[0]) != std::string_view::npos &&
         word[1] == '_' &&
         std::find(kIndices.begin(), kIndices.end(), word.substr(2)) != kIndices.end();
}

/// Words as HTML, with indices as the paper prints them: k_L as k<sub>L</sub>.
std::string words(const std::string& plain) {
  const auto in_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  const std::string html = escaped(plain);
  std::string out;
  for (auto at = html.begin(); at != html.end();) {
    const auto end = std::find_if_not(at, html.end(), in_word);
    const std::string word(at, end);
    out +=
        has_index(word) ? fmt::format("{}<sub>{}</sub>", word.substr(0, 1), word.substr(2)) : word;
    if (end == html.end()) break;
    out += *end;
    at = end + 1;
  }
  return out;
}

/// Values as HTML, which a line break must not split: "46.0 % [45.3, 46.7]" may break only between
/// % and [.
std::string values(const std::string& plain) {
  std::string out;
  const std::string all = words(plain);
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

/// An HTML element with its end tag: <p class="why">...</p> from element("p class=\"why\"", ...).
std::string element(std::string_view opening, std::string_view inside) {
  return fmt::format("<{}>{}</{}>\n", opening, inside, opening.substr(0, opening.find(' ')));
}
/// An entry of a list of names and values.
std::string list_entry(const char* name, const std::string& value) {
  return element("div", element("dt", name) + element("dd", value));
}

std::string paragraphs(const std::vector<std::string>& list) {
  std::string out;
  for (const std::string& p : list) out += element("p", words(p));
  return out;
}

std::string badge(Verdict v) {
  return element(fmt::format("span class=\"badge {}\"", mark_of(v).style),
                 fmt::format("<i aria-hidden=\"true\">{}</i>{}", mark_of(v).symbol, name_of(v)));
}

/// Calls `tell` with each verdict that occurs, and the number of claims with this verdict.
template <class Tell>
void each_verdict(const std::vector<Claim>& claims, Tell tell) {
  for (const Verdict v : kOrder)
    if (const auto n = std::count_if(claims.begin(), claims.end(),
                                     [&](const Claim& c) { return c.verdict == v; });
        n > 0)
      tell(v, n);
}

/// A bar of how many claims got each verdict.
std::string tally_of(const std::vector<Claim>& claims) {
  std::string bar;
  each_verdict(claims, [&](Verdict v, std::int64_t n) {
    bar += fmt::format("<span class=\"{}\" style=\"flex-grow:{}\"></span>", mark_of(v).style, n);
  });
  return element("div class=\"bar\" aria-hidden=\"true\"", bar);
}

/// Buttons that show the claims of one verdict only; report.css hides the others.
std::string filter_of(const std::vector<Claim>& claims) {
  const auto button = [](const char* id, const std::string& label, const char* checked) {
    return element("label",
                   fmt::format("<input type=\"radio\" name=\"verdict\" id=\"show-{}\"{}>{}", id,
                               checked, element("span", label)));
  };
  std::string out = button("all", fmt::format("all {}", claims.size()), " checked");
  each_verdict(claims, [&](Verdict v, std::int64_t n) {
    out += button(mark_of(v).style, fmt::format("{} {} {}", mark_of(v).symbol, name_of(v), n), "");
  });
  return out;
}

/// All claims, folded, those that differ first.
std::string folded(const std::vector<Claim>& claims,
                   const std::map<std::string, std::string>& headings) {
  std::string out;
  for (const Verdict v : kOrder)
    for (const Claim& c : claims) {
      if (c.verdict != v) continue;
      const auto heading = headings.find(c.see);
      if (heading == headings.end())
        throw std::invalid_argument(fmt::format("claim {}: no section \"{}\"", c.id, c.see));
      std::string about = list_entry("Paper", values(c.paper)) + list_entry("Here", values(c.ours));
      if (!c.why.empty()) about += list_entry("Remark", words(c.why));
      about += list_entry("Where", fmt::format("{}; here: <a href=\"#{}\">{}</a>", words(c.where),
                                               escaped(c.see), words(heading->second)));
      out += element(
          fmt::format("details class=\"claim {}\" id=\"claim-{}\"", mark_of(v).style, words(c.id)),
          element("summary", badge(v) + element("span", words(c.claim))) + element("dl", about));
    }
  return out;
}

/// A picture as an attribute: the whole SVG as data, so that nothing is fetched.
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
  return fmt::format("<img src=\"{}\" alt=\"{}\">", url, escaped(alt));
}

/// A command in which lines break only between words.
std::string command(const std::string& line) {
  std::string out;
  std::istringstream in(line);
  for (std::string word; in >> word;)
    out += (out.empty() ? "<span>" : " <span>") + escaped(word) + "</span>";
  return element("code", out);
}

/// A picture with the command that made it.
std::string figure(const std::string& file, const std::string& alt, const std::string& caption,
                   const FigureText& figure_text) {
  return element("figure", element(fmt::format("a href=\"{}\"", escaped(file)),
                                   picture(figure_text(file), alt)) +
                               element("figcaption", caption));
}

std::string first_screen(const std::vector<Report::First>& first, const FigureText& figure_text) {
  std::string out;
  for (const Report::First& f : first)
    out += figure(
        f.figure, f.alt,
        element("p", words(f.caption)) + element("div class=\"commands\"", command(f.command)),
        figure_text);
  return out;
}

/// The commands that made a section, and its files.
std::string made_with(const Report::Section& s) {
  std::string commands, files;
  for (const std::string& c : s.commands) commands += command(c);
  for (const std::string& f : s.files) files += fmt::format("<a href=\"{0}\">{0}</a> ", escaped(f));
  const auto n = s.commands.size();
  if (n > 0) commands = element("div class=\"commands\"", commands);
  if (n > 2)
    commands = element("details", element("summary", fmt::format("{} commands", n)) + commands);
  return commands + (files.empty() ? "" : element("p class=\"files\"", "Files: " + files));
}

std::string section(const Report::Section& s, const std::vector<Claim>& claims,
                    const FigureText& figure_text) {
  std::string about;
  for (const Claim& c : claims)
    if (c.see == s.id)
      about += element("li", fmt::format("<a href=\"#claim-{}\">{}{}</a>", words(c.id),
                                         badge(c.verdict), element("span", words(c.claim))));
  if (!about.empty()) about = element("ul class=\"about\" aria-label=\"Claims shown here\"", about);
  const bool plays = !s.film.is_null();
  const std::string shown =
      plays
          ? fmt::format(
                "<figure><div class=\"replay\"><noscript><p>The animation needs JavaScript. {}"
                "</p></noscript></div>\n<script type=\"application/json\" id=\"film\">{}"
                "</script>{}</figure>\n",
                words(s.alt), script_json(text_of(s.film, -1)), element("figcaption", made_with(s)))
          : figure(s.id + ".svg", s.alt, made_with(s), figure_text);
  return element(fmt::format("section id=\"{}\"{}", escaped(s.id), plays ? " class=\"wide\"" : ""),
                 element("h2", words(s.heading)) +
                     element("div class=\"beside\"",
                             shown + element("div class=\"text\"", paragraphs(s.text) + about)));
}

std::string duration(double seconds) {
  if (seconds < 120) return fixed(seconds, seconds < 10 ? 1 : 0) + " s";
  const auto whole = std::llround(seconds);
  return whole < 7200 ? fmt::format("{} min {} s", whole / 60, whole % 60)
                      : fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

std::string made_by(const Report::MadeBy& made) {
  std::string out = element("dl", list_entry("Program", words(made.program)) +
                                      list_entry("Command", command(made.command)) +
                                      list_entry("Seed", std::to_string(kReportSeed)) +
                                      list_entry("Machine", words(made.machine)) +
                                      list_entry("Time taken", duration(made.seconds)) +
                                      list_entry("Date", words(made.date)));
  for (const Report::Scene& scene : made.scenes)
    out += element("details", element("summary", words(scene.name)) +
                                  element("pre tabindex=\"0\"", words(scene.text)));
  return out;
}

}  // namespace

std::string report_page(const Report& report, const FigureText& figure_text) {
  std::map<std::string, std::string> headings;
  std::string contents, sections;
  for (const Report::Section& s : report.sections) {
    // Where room is short, "Fig. 8: traversal of ..." is shortened to "Fig. 8".
    if (!headings.emplace(s.id, s.heading.substr(0, s.heading.find(':'))).second)
      throw std::invalid_argument(fmt::format("two sections \"{}\"", s.id));
    contents +=
        element("li", fmt::format("<a href=\"#{}\">{}</a>", escaped(s.id), words(s.heading)));
    sections += section(s, report.claims, figure_text);
  }
  return filled(carried_file("report.html"), {{"title", words(report.title)},
                                              {"paper", words(report.paper)},
                                              {"css", std::string(carried_file("report.css"))},
                                              {"first", first_screen(report.first, figure_text)},
                                              {"lead", paragraphs(report.lead)},
                                              {"tally", tally_of(report.claims)},
                                              {"filter", filter_of(report.claims)},
                                              {"claims", folded(report.claims, headings)},
                                              {"contents", contents},
                                              {"sections", sections},
                                              {"made_by", made_by(report.made_by)},
                                              {"replay", std::string(carried_file("replay.js"))},
                                              {"theme", std::string(carried_file("theme.js"))},
                                              {"js", std::string(carried_file("report.js"))}});
}

}  // namespace gatewalk::cli
