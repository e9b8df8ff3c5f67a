// SPDX-License-Identifier: MIT
#include "cli/web/embedded.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace {

struct CarriedFile {
  const char* name;  // nullptr after the last file
  const char* begin;
  const char* end;
};

}  // namespace

// cli/web/embedded.cmake makes these as an assembly file.
extern "C" const CarriedFile gatewalk_carried_files[];

namespace gatewalk::cli {

namespace {

const CarriedFile* find(std::string_view name) {
  for (const CarriedFile* file = gatewalk_carried_files; file->name; ++file)
    if (name == file->name) return file;
  return nullptr;
}

}  // namespace

std::string_view carried_file(std::string_view name) {
  const CarriedFile* const file = find(name);
  if (!file) throw std::logic_error("gatewalk carries no file named " + std::string(name));
  return {file->begin, static_cast<std::size_t>(file->end - file->begin)};
}

std::vector<std::string> carried_files() {
  std::vector<std::string> names;
  for (const CarriedFile* file = gatewalk_carried_files; file->name; ++file)
    names.emplace_back(file->name);
  std::sort(names.begin(), names.end());
  return names;
}

bool has_pages() { return find("report.html") != nullptr; }

}  // namespace gatewalk::cli
