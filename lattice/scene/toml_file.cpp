// SPDX-License-Identifier: MIT
#include "lattice/scene/toml_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "lattice/scene/scene.h"
#include "lattice/scene/scene_terrain.h"
#include "lattice/scene/toml_settings.h"

namespace gatewalk::lattice {

struct TomlFile::Parsed {
  std::string name, bytes;
  std::string unreadable{};  // why the file cannot be read, or what else it is
  bool is_matrix = false;
  toml::table document{};
  std::string mistake{};  // why the text is no TOML
};

namespace {

constexpr std::string_view kStandardInput = "standard input", kMatrix = "\x89HDF\r\n\x1a\n";

/// Reads a file; reads one byte more than allowed, to detect a larger file. Throws SceneError.
std::string read_all(std::FILE* file, const std::string& name) {
  std::string text(kMatrix.size(), '\0');
  errno = 0;
  text.resize(std::fread(text.data(), 1, text.size(), file));
  if (text.size() == kMatrix.size() && text != kMatrix) {
    text.resize(kMostSceneBytes + 1);
    text.resize(kMatrix.size() +
                std::fread(text.data() + kMatrix.size(), 1, text.size() - kMatrix.size(), file));
  }
  if (std::ferror(file)) throw SceneError(name + ": cannot be read: " + std::strerror(errno));
  return text;
}

std::string read_all(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (!file) throw SceneError(path + ": cannot be read: " + std::strerror(errno));
  return read_all(file.get(), path);
}

/// The text of standard input, kept because it can be read only once and a later command of the
/// process may ask for it again.
const std::string& standard_input() {
  static const std::string text = read_all(stdin, std::string(kStandardInput));
  return text;
}

}  // namespace

TomlFile::TomlFile(std::string text, std::string name) {
  Parsed parsed{.name = name == "-" ? std::string(kStandardInput) : std::move(name),
                .bytes = std::move(text)};
  try {
    if (parsed.bytes.size() <= kMostSceneBytes)
      parsed.document = parse_toml(
          parsed.bytes, [&](std::size_t line) { return parsed.name + ":" + std::to_string(line); });
  } catch (const SceneError& e) {
    parsed.mistake = e.what();
  }
  parsed_ = std::make_shared<const Parsed>(std::move(parsed));
}

TomlFile::TomlFile(std::shared_ptr<const Parsed> parsed) : parsed_(std::move(parsed)) {}

TomlFile TomlFile::read(const std::string& path) {
  const auto refused = [&](std::string bytes, std::string why, bool is_matrix) {
    return TomlFile(
        std::make_shared<const Parsed>(Parsed{path, std::move(bytes), std::move(why), is_matrix}));
  };
  try {
    std::string text = path == "-" ? standard_input() : read_all(path);
    if (text.starts_with("\x89HDF"))
      return refused(text, path + ": is a matrix (HDF5), and a scene (TOML) is needed here",
                     text == kMatrix && path != "-");
    return {std::move(text), path};
  } catch (const SceneError& e) {
    return refused("", e.what(), false);
  }
}

const std::string& TomlFile::name() const { return parsed_->name; }

bool TomlFile::is_matrix() const { return parsed_->is_matrix; }

const std::string& TomlFile::bytes() const { return parsed_->bytes; }

bool TomlFile::is_whole() const {
  return parsed_->unreadable.empty() && bytes().size() <= kMostSceneBytes;
}

const TomlFile::Parsed& TomlFile::parsed() const {
  if (!parsed_->unreadable.empty()) throw SceneError(parsed_->unreadable);
  return *parsed_;
}

const toml::table& document_of(const TomlFile& file, const std::string& what) {
  const TomlFile::Parsed& parsed = file.parsed();
  if (parsed.bytes.size() > kMostSceneBytes)
    throw SceneError(parsed.name + ": is too large for " + what + ": more than " +
                     std::to_string(kMostSceneBytes) + " bytes");
  if (!parsed.mistake.empty()) throw SceneError(parsed.mistake);
  return parsed.document;
}

std::string TomlFile::map_file() const {
  const auto file = parsed_->document[kTerrainTable]["map_file"].value<std::string>();
  return file ? (std::filesystem::path(name()).parent_path() / *file).string() : "";
}

}  // namespace gatewalk::lattice
