// SPDX-License-Identifier: MIT
#include "tests/fuzz/fuzz.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <typeinfo>

#include "cli/command.h"
#include "lattice/scene/scene.h"
#include "markov/formats/counts.h"

namespace gatewalk::fuzz {
namespace {

/// A folder of this process, in memory if possible; removed by the destructor.
class Folder {
 public:
  Folder() {
    const bool in_memory = ::access("/dev/shm", W_OK) == 0;
    std::string name = (in_memory ? "/dev/shm" : std::filesystem::temp_directory_path().string()) +
                       "/gatewalk_fuzz_XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for inputs");
    path_ = name;
  }
  ~Folder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

bool is_refusal(const std::exception& error) {
  const std::type_info& type = typeid(error);
  if (type != typeid(std::runtime_error) && type != typeid(std::invalid_argument) &&
      type != typeid(lattice::SceneError) && type != typeid(markov::BadFile) &&
      type != typeid(markov::BadChecksum) && type != typeid(cli::UsageError))
    return false;
  const std::string_view text = error.what();
  require(!text.empty(), "a refusal has a message");
  const bool is_plain = std::none_of(text.begin(), text.end(), [](unsigned char c) {
    return (c < ' ' && c != '\n' && c != '\t') || c == 127;
  });
  if (!is_plain) std::fprintf(stderr, "message: %s\n", error.what());
  require(is_plain, "a message has no bytes that a terminal obeys");
  return true;
}

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz: does not hold: %s\n", what);
  std::abort();
}

std::string file_of(std::string_view bytes, const std::string& ending) {
  static const Folder folder;
  const std::string path = folder.path() + "/input" + ending;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  require(file.good(), "the input can be written to a file");
  return path;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::pair<std::string_view, std::string_view> parted(std::string_view bytes) {
  constexpr std::string_view kBetween = "\n---\n";
  const std::size_t at = bytes.find(kBetween);
  if (at == bytes.npos) return {bytes, {}};
  return {bytes.substr(0, at + 1), bytes.substr(at + kBetween.size())};
}

std::string_view take_line(std::string_view& bytes) {
  const std::string_view line = bytes.substr(0, bytes.find('\n'));
  bytes.remove_prefix(std::min(bytes.size(), line.size() + 1));
  return line;
}

}  // namespace gatewalk::fuzz
