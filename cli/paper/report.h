// SPDX-License-Identifier: MIT
#pragma once
/// The report of a reproduction, as report.json and its page show it.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/fields/json_value.h"
#include "cli/paper/claims.h"

namespace gatewalk::cli {

struct Report {
  /// A picture at the beginning of the page, drawn by a command of the studies.
  struct First {
    std::string figure, alt, caption, command;
  };
  /// A section of the page: a figure and its numbers, or a film.
  struct Section {
    std::string id, heading;
    std::vector<std::string> text;
    std::string alt;  // what the figure shows, in words
    std::vector<std::string> commands, files;
    Json film;  // film/replay.h; null: none
  };
  struct Scene {
    std::string name, text;
  };
  struct MadeBy {
    std::string program, command, machine, date;
    double seconds = 0.0;  // of all studies
    std::vector<Scene> scenes;
  };

  std::string title, paper;
  bool quick = false;
  std::vector<Claim> claims;
  std::vector<std::string> lead{};  // paragraphs
  std::vector<First> first{};
  std::vector<Section> sections{};
  MadeBy made_by{};

  /// "18 reproduced, 9 agree, 0 cannot be told, 9 differ"
  [[nodiscard]] std::string tally() const;
};
inline constexpr int kReportSeed = 1;

/// Describes the result of `reproduce`.
void describe(Fields& out, const Report& report);

}  // namespace gatewalk::cli
