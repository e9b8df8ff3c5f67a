// SPDX-License-Identifier: MIT
// Matrix files that NetCDF itself has written and whose checksum is good, of any content: by lines
//   dimension NAME LENGTH | group NAME | variable NAME TYPE DIMENSION NUMBERS... | text NAME
//   WORDS...
// (of the last variable: attribute NAME WORDS...). HDF5 sees no damaged bytes.
#include <netcdf.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include "markov/formats/netcdf.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/use_matrix.h"

namespace gatewalk::fuzz {
namespace {

constexpr std::string_view kMark = "crc64-xz:", kZeros = "0000000000000000";

/// Builds a NetCDF file from bytes; whatever NetCDF refuses is left out.
class Draft {
 public:
  Draft() {
    nc_.create();
    group_ = nc_;
    text(NC_GLOBAL, "checksum", std::string(kMark) + std::string(kZeros));
  }

  void take(const std::string& line) {
    std::istringstream words(line);
    std::string what, name;
    words >> what >> name;
    if (name.empty() || name.size() > NC_MAX_NAME || name == "checksum") return;
    if (what == "dimension") {
      std::size_t length = 0;
      words >> length;
      int id = -1;
      if (words && length <= kMostNumbers) (void)nc_def_dim(group_, name.c_str(), length, &id);
    } else if (what == "group") {
      int id = -1;
      if (nc_def_grp(nc_, name.c_str(), &id) == NC_NOERR) group_ = id;
    } else if (what == "variable") {
      variable(name, words);
    } else if (what == "text" || what == "attribute") {
      std::string rest;
      std::getline(words >> std::ws, rest);
      for (std::size_t at = 0; (at = rest.find("\\n", at)) != rest.npos;) rest.replace(at, 2, "\n");
      if (what == "text")
        text(NC_GLOBAL, name, rest);
      else if (variable_ >= 0)
        (void)nc_put_att_text(group_, variable_, name.c_str(), rest.size(), rest.data());
    } else if (what == "number") {
      int number = 0;
      words >> number;
      (void)nc_put_att_int(nc_, NC_GLOBAL, name.c_str(), NC_INT, 1, &number);
    }
  }

  /// The whole file with its checksum.
  [[nodiscard]] std::string sealed() {
    const std::vector<char> image = nc_.close_image();
    std::string bytes(image.begin(), image.end());
    const std::size_t mark = bytes.find(kMark);
    if (mark == bytes.npos) return bytes;
    boost::crc_optimal<64, 0x42F0E1EBA9EA3693, ~0ULL, ~0ULL, true, true> crc;
    crc.process_bytes(bytes.data(), bytes.size());
    std::string digits;
    for (int shift = 60; shift >= 0; shift -= 4)
      digits += "0123456789abcdef"[(crc.checksum() >> shift) & 15];
    return bytes.replace(mark + kMark.size(), digits.size(), digits);
  }

 private:
  static constexpr std::size_t kMostNumbers = 5000;

  void text(int variable, const std::string& name, const std::string& words) {
    (void)nc_put_att_text(nc_, variable, name.c_str(), words.size(), words.data());
  }

  void variable(const std::string& name, std::istringstream& words) {
    std::string type, dimension;
    words >> type >> dimension;
    static const std::map<std::string, nc_type> kTypes{{"int", NC_INT},       {"int64", NC_INT64},
                                                       {"double", NC_DOUBLE}, {"float", NC_FLOAT},
                                                       {"char", NC_CHAR},     {"byte", NC_BYTE}};
    const auto known = kTypes.find(type);
    std::vector<int> ids;
    std::size_t size = 1;
    std::istringstream names(dimension);
    for (std::string one; std::getline(names, one, ',');) {
      int id = -1;
      std::size_t length = 0;
      if (nc_inq_dimid(group_, one.c_str(), &id) != NC_NOERR ||
          nc_inq_dimlen(group_, id, &length) != NC_NOERR)
        return;
      ids.push_back(id);
      size *= length;
    }
    if (known == kTypes.end() || size > kMostNumbers) return;
    if (nc_def_var(group_, name.c_str(), known->second, static_cast<int>(ids.size()), ids.data(),
                   &variable_) != NC_NOERR) {
      variable_ = -1;
      return;
    }
    if (size == 0) return;
    if (known->second == NC_CHAR) {
      std::string all;
      std::getline(words >> std::ws, all);
      all.resize(size, ' ');
      (void)nc_put_var_text(group_, variable_, all.data());
      return;
    }
    std::vector<long long> whole;
    std::vector<double> real;
    for (std::string word; words >> word && real.size() < size;) {
      char* end = nullptr;
      whole.push_back(std::strtoll(word.c_str(), &end, 10));
      real.push_back(std::strtod(word.c_str(), &end));
    }
    whole.resize(size, whole.empty() ? 0 : whole.back());  // repeats the last one
    real.resize(size, real.empty() ? 0.0 : real.back());
    if (known->second == NC_DOUBLE || known->second == NC_FLOAT)
      (void)nc_put_var_double(group_, variable_, real.data());
    else
      (void)nc_put_var_longlong(group_, variable_, whole.data());
  }

  markov::netcdf::Image nc_;
  int group_ = -1, variable_ = -1;
};

}  // namespace

void matrix_content(std::string_view bytes) {
  constexpr int kMostLines = 200;
  Draft draft;
  for (int line = 0; line < kMostLines && !bytes.empty(); ++line)
    draft.take(std::string(take_line(bytes)));
  use_matrix(file_of(draft.sealed(), ".nc"));
}

}  // namespace gatewalk::fuzz
