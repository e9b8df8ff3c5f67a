// SPDX-License-Identifier: MIT
// One bit of a file is flipped, again and again: a matrix, a picture or a file of kept pieces is
// then refused, or of pieces the last ones are missing and done again. A picture may also have the
// same pixels: its end says nothing. Never is it read as something else.
//   fuzz_flips FLIPS FILE...   (FILE may be compressed by gzip; a line of CSV each)
#include <zlib.h>

#include <filesystem>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cli/kept/piece_log.h"
#include "lattice/scene/grey_picture.h"
#include "lattice/source/cell_matrix.h"
#include "markov/formats/counts.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace gatewalk;

enum Fate { refused, cut_short, same, silent, kFates };

std::string unpacked(const std::string& path) {
  gzFile file = ::gzopen(path.c_str(), "rb");
  if (file == nullptr) throw std::runtime_error(path + ": cannot be read");
  std::string bytes, block(1 << 16, '\0');
  for (int got = 0; (got = ::gzread(file, block.data(), static_cast<unsigned>(block.size()))) > 0;)
    bytes.append(block, 0, static_cast<std::size_t>(got));
  ::gzclose(file);
  return bytes;
}

Fate fate_of_matrix(const std::string& path) {
  // Not read_matrix, which would look for the fault in a child process.
  return fuzz::accepted([&] { return markov::read_counts(path); }) ? silent : refused;
}

constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n";

/// A picture as a map, with the width and height of its first lines.
lattice::GreyPicture picture_of(const std::string& path, std::string_view whole) {
  const auto number_at = [&](std::size_t at) {  // a number below 256
    return static_cast<int>(static_cast<unsigned char>(whole.at(at + 3)));
  };
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20;
  return lattice::read_grey_png(path, number_at(kWidthAt), number_at(kHeightAt));
}

Fate fate_of_picture(const std::string& path, std::string_view whole,
                     const lattice::GreyPicture& picture) {
  const auto found = fuzz::accepted([&] { return picture_of(path, whole); });
  return !found ? refused : found->grey == picture.grey ? same : silent;
}

/// The content of a file of pieces.
struct Pieces {
  std::string head;
  bool finished = false;
  std::vector<std::string> all;  // stage, items and bytes of each

  explicit Pieces(const std::string& path) {
    const cli::PieceFile file(path);
    head = file.head();
    finished = file.is_finished();
    for (const cli::PieceRecord& r : file.records())
      all.push_back(std::to_string(r.stage) + " " + std::to_string(r.items.first) + " " +
                    std::to_string(r.items.count) + " " + file.bytes_of(r));
  }
};

Fate fate_of_pieces(const std::string& path, const Pieces& whole) {
  const auto found = fuzz::accepted([&] { return Pieces(path); });
  if (!found) return refused;
  const bool is_begin = found->head == whole.head && found->all.size() < whole.all.size() &&
                        std::equal(found->all.begin(), found->all.end(), whole.all.begin());
  return is_begin && !found->finished ? cut_short : silent;
}

/// Flips bits of one file; returns how many flips were not noticed.
int flip(const std::string& path, int flips) {
  const std::string whole = unpacked(path);
  const std::string copy = fuzz::file_of(whole, ".flipped");
  const bool is_pieces = cli::PieceFile::is_one(copy), is_picture = whole.starts_with(kPng);
  const auto picture = is_picture ? picture_of(copy, whole) : lattice::GreyPicture();
  if (!is_pieces && !is_picture) (void)lattice::read_matrix(copy);  // throws unless it is a matrix
  const auto pieces = is_pieces ? std::optional(Pieces(copy)) : std::nullopt;
  std::mt19937_64 random(1);
  int fates[kFates] = {};
  for (int k = 0; k < flips; ++k) {
    const std::size_t bit = random() % (8 * whole.size());
    std::string bytes = whole;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
    (void)fuzz::file_of(bytes, ".flipped");
    const Fate fate = is_pieces    ? fate_of_pieces(copy, *pieces)
                      : is_picture ? fate_of_picture(copy, whole, picture)
                                   : fate_of_matrix(copy);
    ++fates[fate];
    if (fate == silent) std::cerr << path << ": bit " << bit << " is not noticed\n";
  }
  std::cout << std::filesystem::path(path).filename().string() << ',' << whole.size() << ','
            << flips << ',' << fates[refused] << ',' << fates[cut_short] << ',' << fates[same]
            << ',' << fates[silent] << '\n';
  return fates[silent];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: fuzz_flips FLIPS FILE...\n";
    return 2;
  }
  std::cout << "file,bytes,flips,refused,cut_short,same,silent\n";
  int unnoticed = 0;
  for (int i = 2; i < argc; ++i) unnoticed += flip(argv[i], std::stoi(argv[1]));
  return unnoticed == 0 ? 0 : 1;
}
