// SPDX-License-Identifier: MIT
#include "cli/paper/report.h"

#include <fmt/core.h>

#include <algorithm>

#include "cli/fields/json.h"
#include "cli/film/replay.h"

namespace gatewalk::cli {
namespace {

void describe(Fields& out, const Claim& c) {
  out.text({"id", "name of the claim"}, c.id);
  out.text({"where", "where the paper makes it"}, c.where);
  out.text({"claim", "what the paper claims"}, c.claim);
  out.text({"paper", "the paper's value"}, c.paper);
  out.text({"ours", "the value here, shares with 95 % intervals"}, c.ours);
  out.text(Label("verdict", "of the two").one_of({kVerdictNames.begin(), kVerdictNames.end()}),
           name_of(c.verdict));
  out.text({"why", "what was compared, and why it differs, as far as it is known"}, c.why);
  out.text({"see", "the section that shows it"}, c.see);
}

void describe(Fields& out, const Report::First& f) {
  out.text({"figure", "file of the picture"}, f.figure);
  out.text({"alt", "what the picture shows, in words"}, f.alt);
  out.text({"caption", "line below the picture"}, f.caption);
  out.text({"command", "the command that drew it"}, f.command);
}

void describe(Fields& out, const Report::Section& s) {
  out.text({"id", "name of the section and of its files"}, s.id);
  out.text({"heading", "heading of the section"}, s.heading);
  out.texts({"text", "paragraphs"}, s.text);
  out.text({"alt", "what the figure shows, in words"}, s.alt);
  out.texts({"commands", "the commands whose results it shows"}, s.commands);
  out.texts({"files", "the figure and its numbers"}, s.files);
  out.optional(!s.film.is_null(), [&](Fields& f) {
    f.as_kept({"film", "runs to be played, as trace records them"}, s.film, [](Fields& film) {
      describe_version(film);
      Film one;
      one.runs.resize(1);
      describe(film, one);
    });
  });
}

void describe(Fields& out, const Report::MadeBy& m) {
  out.text({"program", "name, version and commit of the program"}, m.program);
  out.text({"command", "the command that made the report"}, m.command);
  out.count({"seed", "1", "seed of all studies"}, kReportSeed);
  out.text({"machine", "what times were measured on"}, m.machine);
  out.number({"seconds", "s", "time that all studies took"}, m.seconds);
  out.text({"date", "day on which the report was made"}, m.date);
  out.list({"scenes", "the scenes of the studies"}, m.scenes,
           [](Fields& scene, const Report::Scene& s) {
             scene.text({"name", "file of the scene"}, s.name);
             scene.text({"text", "the scene as TOML"}, s.text);
           });
}

constexpr auto described = [](Fields& out, const auto& part) { describe(out, part); };

}  // namespace

void describe(Fields& out, const Report& r) {
  out.text({"title", "title of the page"}, r.title);
  out.text({"paper", "the paper whose results are made again"}, r.paper);
  out.flag({"quick", "whether it was made of fewer trials (--quick)"}, r.quick);
  out.list({"claims", "the paper's claims beside what was found"}, r.claims, described);
  out.texts({"lead", "paragraphs that the page begins with"}, r.lead);
  out.list({"first", "pictures that the page begins with"}, r.first, described);
  out.list({"sections", "figures with their numbers"}, r.sections, described);
  out.object({"made_by", "where the report comes from"},
             [&](Fields& made_by) { describe(made_by, r.made_by); });
}

std::string Report::tally() const {
  const auto count = [&](Verdict verdict) {
    return std::count_if(claims.begin(), claims.end(),
                         [&](const Claim& c) { return c.verdict == verdict; });
  };
  return fmt::format("{} reproduced, {} agree, {} cannot be told, {} differ",
                     count(Verdict::reproduced), count(Verdict::agrees),
                     count(Verdict::cannot_tell), count(Verdict::differs));
}

}  // namespace gatewalk::cli
