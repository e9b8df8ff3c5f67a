// SPDX-License-Identifier: MIT
#pragma once
/// Writing and reading NetCDF-4 in a memory image: HDF5 1.10 crashes at exit after a failed write
/// to a file, and files are replaced as a whole. Not part of the installed headers.

#include <netcdf.h>
#include <netcdf_mem.h>

#include <cstdint>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

namespace gatewalk::markov::netcdf {

/// Throws std::runtime_error naming `what` if `rc` is an error; std::bad_alloc if memory is short.
inline void check(int rc, const std::string& what) {
  if (rc == NC_NOERR) return;
  if (rc == NC_ENOMEM) throw std::bad_alloc();
  const bool is_missing =
      rc == NC_ENOTVAR || rc == NC_EBADDIM || rc == NC_ENOTATT || rc == NC_ENOGRP;
  throw std::runtime_error(what +
                           (is_missing ? " is missing" : std::string(": ") + nc_strerror(rc)));
}

inline constexpr const char* kCannotOpen = "cannot open: cut short or damaged, or not NetCDF-4";

/// Stops HDF5 from printing errors in this thread; HDF5 counts every negative answer as an error.
/// NetCDF does this itself, but only in the thread that calls it first. Call this before NetCDF.
void silence_hdf5();

class Image {
 public:
  Image() { silence_hdf5(); }
  ~Image() {
    if (is_open_) nc_abort(id_);
  }
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;

  void create() {
    constexpr std::size_t kFirstBytes = 1 << 16;
    check(nc_create_mem("image", NC_NETCDF4, kFirstBytes, &id_), "cannot create");
    is_open_ = true;
  }
  void open(std::vector<char>& image) {
    if (const int rc = nc_open_mem("image", NC_NOWRITE, image.size(), image.data(), &id_);
        rc != NC_NOERR && rc != NC_ENOMEM)
      throw std::runtime_error(kCannotOpen);
    else
      check(rc, "memory");
    is_open_ = true;
  }
  [[nodiscard]] std::vector<char> close_image() {
    is_open_ = false;
    NC_memio memory{};
    check(nc_close_memio(id_, &memory), "cannot finish");
    const char* bytes = static_cast<const char*>(memory.memory);
    std::vector<char> image(bytes, bytes + memory.size);
    std::free(memory.memory);
    return image;
  }
  operator int() const { return id_; }

 private:
  int id_ = -1;
  bool is_open_ = false;
};

constexpr nc_type type_of(const std::vector<std::int8_t>&) { return NC_BYTE; }
constexpr nc_type type_of(const std::vector<std::int32_t>&) { return NC_INT; }
constexpr nc_type type_of(const std::vector<std::int64_t>&) { return NC_INT64; }
constexpr nc_type type_of(const std::vector<double>&) { return NC_DOUBLE; }

inline void put_text(int nc, int variable, const std::string& name, const std::string& text) {
  check(nc_put_att_text(nc, variable, name.c_str(), text.size(), text.data()), "attribute " + name);
}

/// Marks a file as following the Climate and Forecast conventions (CF).
inline void put_conventions(int nc) { put_text(nc, NC_GLOBAL, "Conventions", "CF-1.10"); }

inline int define_dimension(int nc, const std::string& name, std::size_t length) {
  int dimension = -1;
  // A length of 0 is NC_UNLIMITED, which is how NetCDF stores an empty list.
  check(nc_def_dim(nc, name.c_str(), length, &dimension), "dimension " + name);
  return dimension;
}

/// Defines and writes a compressed, checksummed variable; returns its number.
template <class T>
int put_variable(int nc, const std::string& name, int dimension, const std::vector<T>& values,
                 const std::string& unit, const std::string& meaning) {
  constexpr int kShuffle = 1, kDeflate = 1, kLevel = 4;
  int variable = -1;
  check(nc_def_var(nc, name.c_str(), type_of(values), 1, &dimension, &variable), name);
  check(nc_def_var_deflate(nc, variable, kShuffle, kDeflate, kLevel), name);
  check(nc_def_var_fletcher32(nc, variable, NC_FLETCHER32), name);
  if (!unit.empty()) put_text(nc, variable, "units", unit);
  put_text(nc, variable, "long_name", meaning);
  const std::size_t first = 0;
  const std::size_t count = values.size();
  if (count > 0) check(nc_put_vara(nc, variable, &first, &count, values.data()), name);
  return variable;
}

}  // namespace gatewalk::markov::netcdf
