// SPDX-License-Identifier: MIT
#include "lattice/text/csv.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>

namespace gatewalk::lattice {

std::optional<std::vector<std::string>> lines_of(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  if (std::filesystem::is_directory(path)) {
    errno = EISDIR;
    return {};
  }
  file.exceptions(std::ios_base::badbit);  // else what cannot be read looks like the end
  std::vector<std::string> lines;
  try {
    for (std::string text; std::getline(file, text);) {
      if (lines.empty() && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
      if (text.ends_with('\r')) text.pop_back();
      lines.push_back(text);
    }
  } catch (const std::ios_base::failure&) {
    errno = EIO;
    return {};
  }
  return lines;
}

std::optional<std::vector<std::string>> csv_fields(std::string_view line) {
  constexpr const char* kSpace = " \t";
  std::vector<std::string> fields;
  for (std::size_t at = 0;;) {
    const std::size_t first = std::min(line.find_first_not_of(kSpace, at), line.size());
    std::string field;
    if (first < line.size() && line[first] == '"') {
      at = first + 1;
      for (;; ++at) {
        if (at >= line.size()) return {};
        if (line[at] == '"' && line.substr(at + 1, 1) != "\"") break;
        if (line[at] == '"') ++at;  // two stand for one
        field += line[at];
      }
      at = std::min(line.find_first_not_of(kSpace, at + 1), line.size());
      if (at < line.size() && line[at] != ',') return {};
    } else {
      at = std::min(line.find(',', first), line.size());
      field = line.substr(first, at - first);
      field.erase(field.find_last_not_of(kSpace) + 1);
    }
    fields.push_back(std::move(field));
    if (at == line.size()) return fields;
    ++at;  // the comma
  }
}

bool says_nothing(std::string_view field) {
  constexpr std::array<std::string_view, 11> kWords{"",     "na",   "n/a",  "nan", "-nan", "none",
                                                    "null", "<na>", "#n/a", "#na", "-"};
  std::string word(field);
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
}

bool has_no_fields(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == line.npos) return true;
  return line[first] == '#' && !says_nothing(line.substr(first, line.find(',', first) - first));
}

}  // namespace gatewalk::lattice
