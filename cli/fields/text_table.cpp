// SPDX-License-Identifier: MIT
#include "cli/fields/text_table.h"

#include <algorithm>
#include <cstdlib>

#include "cli/fields/text.h"

namespace gatewalk::cli {
namespace {

/// The number of UTF-8 characters.
int length_of(std::string_view text) {
  // Counts the first byte of each character; continuation bytes are 10xxxxxx.
  return static_cast<int>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// Text padded with blanks to `width`: on the left, or for a negative width on the right.
std::string padded(const std::string& text, int width) {
  const std::string space(static_cast<std::size_t>(std::max(0, std::abs(width) - length_of(text))),
                          ' ');
  return width > 0 ? space + text : text + space;
}

}  // namespace

std::string TextCell::text_in(const TextColumn& column) const {
  if (const auto* words = std::get_if<std::string>(&content_)) return *words;
  const std::string number = fixed(std::get<double>(content_), column.decimals);
  return column.unit.empty() ? number : number + " " + column.unit;
}

void TextTable::row(const std::vector<TextCell>& cells) {
  Line line;
  for (const TextCell& cell : cells) line.push_back(cell.text_in(columns_.at(line.size())));
  lines_.push_back(std::move(line));
}

TextTable::Line TextTable::headings() const {
  Line line;
  for (const TextColumn& column : columns_) line.push_back(column.heading);
  return line;
}

int TextTable::width_of(std::size_t column) const {
  const int width = columns_[column].width;
  if (std::abs(width) != kFit) return width;
  int widest = length_of(columns_[column].heading);
  for (const Line& line : lines_)
    if (column < line.size()) widest = std::max(widest, length_of(line[column]));
  return width > 0 ? widest : -widest;
}

std::string TextTable::text_of(const Line& line) const {
  std::string text;
  for (std::size_t c = 0; c < line.size(); ++c)
    text += columns_[c].before + padded(line[c], width_of(c));
  return text + "\n";
}

std::string TextTable::header() const {
  const bool any = std::any_of(columns_.begin(), columns_.end(),
                               [](const TextColumn& c) { return !c.heading.empty(); });
  return any ? text_of(headings()) : "";
}

std::string TextTable::rows() const {
  std::string text;
  for (const Line& line : lines_) text += text_of(line);
  return text;
}

}  // namespace gatewalk::cli
