// SPDX-License-Identifier: MIT
#include "markov/formats/counts.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netcdf.h>
#include <netcdf_mem.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <thread>

#include "chains.h"
#include "markov/formats/file.h"

namespace {

// The system calls that write a file, so that a test can make the k-th of them fail. They replace
// the C library's calls and, unless armed, pass everything on.
struct Disk {
  bool armed = false;
  bool for_ever = false;
  int fail_at = 0;  // from 1
  int calls = 0;
  std::size_t most_per_write = std::numeric_limits<std::size_t>::max();

  bool fails() {
    if (!armed) return false;
    ++calls;
    return for_ever ? calls >= fail_at : calls == fail_at;
  }
};
Disk disk;

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t count) {
  if (disk.fails()) {
    errno = ENOSPC;
    return -1;
  }
  return syscall(SYS_write, file, bytes, disk.armed ? std::min(count, disk.most_per_write) : count);
}

int fsync(int file) {
  if (disk.fails()) {
    errno = EIO;
    return -1;
  }
  return static_cast<int>(syscall(SYS_fsync, file));
}

int close(int file) {
  const bool fails = disk.fails();
  const long rc = syscall(SYS_close, file);
  if (fails) errno = EIO;
  return fails ? -1 : static_cast<int>(rc);
}

int rename(const char* from, const char* to) noexcept {
  if (disk.fails()) {
    errno = EROFS;
    return -1;
  }
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

}  // extern "C"

namespace gatewalk::markov {
namespace {

namespace fs = std::filesystem;

// A fixture with a folder for each test.
class ChainIo : public testing::Test {
 protected:
  ChainIo() {
    std::string name = testing::TempDir() + "chain_io_XXXXXX";
    if (!::mkdtemp(name.data())) throw std::runtime_error("no folder for the test");
    folder_ = name;
  }
  ~ChainIo() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name = "counts.nc") const {
    return (folder_ / name).string();
  }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), {});
  }

 private:
  fs::path folder_;
};

CountsFile example() {
  CountsFile file;
  file.counts = test::lattice_counts(1);
  test::empty_row(file.counts, 41);
  for (int row = 0; row < 87; ++row) {
    file.trials.push_back(file.counts.row(row).sum());
    file.clamped.push_back(file.trials.back() / 7);
  }
  file.exits = test::lattice_exits();
  file.arrays = {{"empty", "", "", {}},
                 {"speed_edges", "m/s", "bin edges of \xc3\xbc", {-0.0, 1.5, 1e300, 0.1}},
                 {"x2", "1", "", {7.0}},
                 {"of_rows", "1", "a number each", std::vector<double>(87, 0.5), "input_state"},
                 {"pair_a", "s", "", {1.5, 2.5}, "pair"},
                 {"pair_b", "1", "", {2, -1}, "pair", true},
                 {"side", "1", "", {1, 0, 1}, "", true, {"left", "right"}}};
  std::sort(file.arrays.begin(), file.arrays.end(),
            [](const NamedArray& a, const NamedArray& b) { return a.name < b.name; });
  for (int j = 0; j < 88; ++j)
    file.state_names.push_back(j < 87 ? "EN_" + std::to_string(j) : "trapped");
  file.text = {{"scene", "F_prop = 8 # N\n\xc3\x84\tRm = 20"}, {"seed", "1"}, {"remark", ""}};
  return file;
}

bool same(const NamedArray& a, const NamedArray& b) {
  return a.name == b.name && a.unit == b.unit && a.meaning == b.meaning &&
         a.dimension == b.dimension && a.whole == b.whole && a.codes == b.codes &&
         std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                    [](double x, double y) {
                      return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
                    });
}

bool same(const RowCounts& a, const RowCounts& b) {
  const Eigen::Matrix<std::int64_t, -1, -1> dense_a = a.counts, dense_b = b.counts;
  return dense_a.rows() == dense_b.rows() && dense_a.cols() == dense_b.cols() &&
         dense_a == dense_b && a.trials == b.trials && a.clamped == b.clamped;
}

bool same(const CountsFile& a, const CountsFile& b) {
  return same(static_cast<const RowCounts&>(a), b) &&
         std::equal(a.types.begin(), a.types.end(), b.types.begin(), b.types.end(),
                    [](const auto& x, const auto& y) {
                      return x.first == y.first && same(x.second, y.second);
                    }) &&
         a.exits == b.exits && a.text == b.text && a.state_names == b.state_names &&
         std::equal(a.arrays.begin(), a.arrays.end(), b.arrays.begin(), b.arrays.end(),
                    [](const NamedArray& x, const NamedArray& y) { return same(x, y); });
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// The message of read_counts about a file; anything else (output on stderr, another exception) is a
// failure.
std::string complaint(const std::string& path) {
  testing::internal::CaptureStderr();
  std::string what = "accepted";
  try {
    (void)read_counts(path);
  } catch (const BadFile& error) {
    what = error.what();
    EXPECT_EQ(what.rfind(path + ": ", 0), 0U) << what;
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  return what;
}

void expect_complaint(const std::string& path, const std::string& part) {
  const std::string what = complaint(path);
  EXPECT_NE(what.find(part), std::string::npos) << what;
}

// CRC-64/XZ bit by bit, and the checksum as markov/formats/counts.h describes it.
std::uint64_t crc64(const std::string& bytes) {
  std::uint64_t crc = ~std::uint64_t{0};
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) ? 0xC96C5795D7870F42U : 0U);
  }
  return ~crc;
}

std::string sealed(std::string bytes) {
  const std::string mark = "crc64-xz:";
  const std::size_t at = bytes.find(mark) + mark.size();
  bytes.replace(at, 16, 16, '0');
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(crc64(bytes)));
  return bytes.replace(at, 16, digits);
}

// ---- Reading returns what was written ----

TEST_F(ChainIo, RoundTrip) {
  const CountsFile file = example();
  write_counts(path(), file);
  EXPECT_TRUE(same(read_counts(path()), file));
  EXPECT_EQ(files(), 1);

  CountsFile other = file;
  other.clamped[3] += 1;
  write_counts(path(), other);
  EXPECT_TRUE(same(read_counts(path()), other));
  EXPECT_FALSE(same(read_counts(path()), file));
}

// HDF5 has a switch for printing in every thread, and NetCDF asks HDF5 for much that does not
// exist.
TEST_F(ChainIo, NothingIsPrintedInAnyThread) {
  write_counts(path(), example());  // NetCDF is first called in this thread
  testing::internal::CaptureStderr();
  std::thread([&] { EXPECT_TRUE(same(read_counts(path()), example())); }).join();
  std::thread([&] { write_counts(path(), example()); }).join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// A random valid file: 1 to 9 rows, some of them empty, sometimes with the largest numbers.
CountsFile any_file(test::Words& words) {
  const auto any = [&](std::initializer_list<double> numbers) {
    return numbers.begin()[words.below(static_cast<int>(numbers.size()))];
  };
  const int rows = 1 + words.below(9), columns = rows + words.below(3);
  CountsFile file;
  const auto fill = [&](RowCounts& some) {
    some.counts.resize(rows, columns);
    for (int row = 0; row < rows; ++row) {
      std::int64_t sum = 0;
      for (int n = words.below(4); n > 0; --n) {
        const std::int64_t most = std::numeric_limits<std::int64_t>::max() - sum;
        const std::int64_t count =
            words.below(20) == 0 ? most : std::min<std::int64_t>(most, words.below(100));
        // Or a stored zero, which is no content.
        some.counts.coeffRef(row, words.below(columns)) += count;
        sum += count;
      }
      some.trials.push_back(sum);
      some.clamped.push_back(words.below(2) ? sum : sum / 2);
    }
  };
  fill(file);
  for (int t = words.below(3); t > 0; --t) fill(file.types["type" + std::to_string(t)]);
  constexpr int kMost = std::numeric_limits<int>::max(), kLeast = std::numeric_limits<int>::min();
  for (int j = 0; j < columns; ++j)
    file.exits.push_back(
        words.below(4) ? Exit{words.below(rows), words.below(3) - 1, words.below(9) ? 1 : kMost}
                       : Exit{});
  if (words.below(9) == 0) file.exits[0] = {0, kLeast, kMost};
  for (int n = words.below(5); n > 0; --n) {
    NamedArray array{"of_" + std::to_string(n), words.below(2) ? "m s-1" : "", "\xc3\xbc, \"", {}};
    const bool of_rows = words.below(3) == 0, is_code = !of_rows && words.below(3) == 0;
    if (of_rows) array.dimension = "input_state";
    if (is_code) {
      array.whole = true;
      array.codes = {"left", "right"};
    }
    for (int k = of_rows ? rows : words.below(2000); k > 0; --k)
      array.values.push_back(is_code ? words.below(2) : any({-0.0, 0.1, 5e-324, 1e300, -1.5}));
    file.arrays.push_back(array);
  }
  if (words.below(2))
    for (int j = 0; j < columns; ++j) file.state_names.push_back("EN_" + std::to_string(j));
  for (int n = words.below(4); n > 0; --n)
    file.text["text" + std::to_string(n)] =
        std::string(words.below(9) ? words.below(9) : 59'000, 'x') + "# \n\xc3\x84\t\"";
  return file;
}

// Numbers are equal to the bit; arrays are read back by name. The same content gives the same
// bytes.
TEST_F(ChainIo, AnyFileReadsBackTheSame) {
  test::Words words(3);
  for (int k = 0; k < 100; ++k) {
    SCOPED_TRACE(k);
    CountsFile file = any_file(words);
    write_counts(path(), file);
    CountsFile back = read_counts(path());
    std::sort(file.arrays.begin(), file.arrays.end(),
              [](const NamedArray& a, const NamedArray& b) { return a.name < b.name; });
    EXPECT_TRUE(same(back, file));
    write_counts(path(), file);
    write_counts(path("again"), back);
    EXPECT_TRUE(bytes_of(path()) == bytes_of(path("again")));
    EXPECT_EQ(files(), 2);
    back.clamped[0] ^= 1;
    EXPECT_FALSE(same(back, file));
  }
}

// Free space between the rows of a matrix holds no counts.
TEST_F(ChainIo, NumbersOfCountsMayComeWithAMatrixThatHasGaps) {
  CountsFile file = example();
  file.counts.makeCompressed();
  const auto nonzero = static_cast<std::size_t>((file.counts.coeffs() != 0).count());
  file.arrays = {{"of_counts", "1", "", std::vector<double>(nonzero, 0.5), "nonzero"}};
  write_counts(path("a"), file);
  file.counts.reserve(Eigen::VectorXi::Constant(87, 4));
  ASSERT_FALSE(file.counts.isCompressed());
  for (int row = 0; row < 87; ++row)
    for (auto at = file.counts.outerIndexPtr()[row] + file.counts.innerNonZeroPtr()[row];
         at < file.counts.outerIndexPtr()[row + 1]; ++at)
      file.counts.valuePtr()[at] = 0;
  write_counts(path("b"), file);
  EXPECT_EQ(bytes_of(path("a")), bytes_of(path("b")));
}

TEST_F(ChainIo, ChecksumIsTheDocumentedOne) {
  EXPECT_EQ(crc64("123456789"), 0x995dc9bbdf1939faU);
  write_counts(path(), example());
  EXPECT_EQ(bytes_of(path()), sealed(bytes_of(path())));
}

TEST_F(ChainIo, RelativePathsAndOddNames) {
  const fs::path before = fs::current_path();
  fs::current_path(fs::path(path()).parent_path());
  for (const std::string name : {"plain", "with space.nc", "s3:x#mode=zarr", "back\\slash"}) {
    write_counts(name, example());
    EXPECT_TRUE(same(read_counts(name), example())) << name;
  }
  fs::current_path(before);
}

// ---- Inconsistent content is not written ----

TEST_F(ChainIo, RefusesToWriteWhatDoesNotAddUp) {
  write_counts(path(), example());
  const auto refused = [&](const std::string& part, const std::function<void(CountsFile&)>& spoil) {
    CountsFile file = example();
    spoil(file);
    try {
      write_counts(path(), file);
      ADD_FAILURE() << "written: " << part;
    } catch (const std::invalid_argument& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.rfind(path() + ": ", 0), 0U) << what;
      EXPECT_NE(what.find(part), std::string::npos) << what;
    }
    EXPECT_TRUE(same(read_counts(path()), example()));
    EXPECT_EQ(files(), 1);
  };
  refused("row 4 (counted from 0): counts add up to", [](CountsFile& f) { f.trials[4] += 1; });
  refused("row 41 (counted from 0): counts add up to 0", [](CountsFile& f) { f.trials[41] = 1; });
  refused("row 0 (counted from 0): a count is negative",
          [](CountsFile& f) { f.counts.coeffRef(0, 1) = -1; });
  refused("the sum of counts overflows", [](CountsFile& f) {
    f.counts.coeffRef(0, 1) = std::numeric_limits<std::int64_t>::max();
  });
  refused("row 2 (counted from 0): -1 clamped", [](CountsFile& f) { f.clamped[2] = -1; });
  refused("row 2", [](CountsFile& f) { f.clamped[2] = f.trials[2] + 1; });
  refused("each of the 87 rows", [](CountsFile& f) { f.trials.pop_back(); });
  refused("each of the 87 rows", [](CountsFile& f) { f.clamped.push_back(0); });
  refused("87 exits for 88 outputs", [](CountsFile& f) { f.exits.pop_back(); });
  refused("exit of output 87", [](CountsFile& f) { f.exits.back().di_x = 1; });
  refused("name \"trials\" is taken", [](CountsFile& f) { f.arrays[0].name = "trials"; });
  refused("name \"empty\" is taken", [](CountsFile& f) { f.arrays[1].name = "empty"; });
  refused("name \"empty_length\" is taken",
          [](CountsFile& f) { f.arrays[1].name = "empty_length"; });
  refused("name \"empty_length\" is taken", [](CountsFile& f) {
    f.arrays = {{"empty_length", "", "", {}}, {"empty", "", "", {}}};
  });
  const auto array = [](CountsFile& f, const std::string& name) -> NamedArray& {
    return *std::find_if(f.arrays.begin(), f.arrays.end(),
                         [&](const NamedArray& a) { return a.name == name; });
  };
  refused("array pair_b has 3 numbers, its dimension pair 2",
          [&](CountsFile& f) { array(f, "pair_b").values.push_back(1); });
  refused("array of_rows has 86 numbers, its dimension input_state 87",
          [&](CountsFile& f) { array(f, "of_rows").values.pop_back(); });
  refused("name \"x2\" is taken", [&](CountsFile& f) { array(f, "pair_a").dimension = "x2"; });
  refused("array side: 0.500000 is no whole number",
          [&](CountsFile& f) { array(f, "side").values[1] = 0.5; });
  refused("array side: code \"a b\" is no word",
          [&](CountsFile& f) { array(f, "side").codes[0] = "a b"; });
  refused("only whole numbers have codes", [&](CountsFile& f) { array(f, "x2").codes = {"a"}; });
  refused("every output must have one of its own", [](CountsFile& f) { f.state_names.pop_back(); });
  refused("every output must have one of its own",
          [](CountsFile& f) { f.state_names[3] = f.state_names[4]; });
  refused("is no name", [](CountsFile& f) { f.state_names[3] = "EN "; });
  refused("name \"checksum\" is taken", [](CountsFile& f) { f.text["checksum"] = "1"; });
  for (const std::string name : {"", "1st", "_x", "a b", "a/b", "\xc3\xa9t\xc3\xa9"}) {
    refused("name \"" + name + "\"", [&](CountsFile& f) { f.arrays[0].name = name; });
    refused("name \"" + name + "\"", [&](CountsFile& f) { f.text[name] = "1"; });
  }
  refused("type s: row 4 (counted from 0): counts add up to", [](CountsFile& f) {
    f.types["s"] = static_cast<const RowCounts&>(f);
    f.types["s"].trials[4] += 1;
  });
  refused("type s: its counts are of another size", [](CountsFile& f) { f.types["s"]; });
  refused("name \"type_x-y\"",
          [](CountsFile& f) { f.types["x-y"] = static_cast<const RowCounts&>(f); });
  refused("60001 bytes", [](CountsFile& f) { f.text["scene"] = std::string(60'001, 'x'); });
  refused("zero byte", [](CountsFile& f) { f.arrays[0].unit = std::string("m\0s", 3); });
}

TEST_F(ChainIo, TheMarkOfTheChecksumMayNotStandInText) {
  CountsFile file = example();
  file.text["remark"] = "crc64-xz:0000000000000000";
  EXPECT_THROW(write_counts(path(), file), std::runtime_error);
  EXPECT_EQ(files(), 0);
}

// ---- Damage ----

TEST_F(ChainIo, EveryTruncationIsRefused) {
  write_counts(path(), example());
  const std::string whole = bytes_of(path());
  for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 400) {
    put_bytes(path(), whole.substr(0, length));
    EXPECT_NE(complaint(path()), "accepted") << length;
  }
  put_bytes(path(), whole + '\0');
  expect_complaint(path(), "checksum does not match");
}

TEST_F(ChainIo, EveryAlteredByteIsRefused) {
  write_counts(path(), example());
  const std::string bytes = bytes_of(path());
  std::fstream file(path(), std::ios::binary | std::ios::in | std::ios::out);
  const auto put = [&file](std::size_t at, char byte) {
    file.seekp(static_cast<std::streamoff>(at)).put(byte).flush();
  };
  test::Words words(1);
  for (int k = 0; k < 10'000; ++k) {
    const auto at = static_cast<std::size_t>(words() % bytes.size());
    put(at, static_cast<char>(bytes[at] ^ (1 + words.below(255))));
    try {
      (void)read_counts(path());
      ADD_FAILURE() << "accepted with byte " << at << " altered";
    } catch (const BadFile&) {
    }
    put(at, bytes[at]);
  }
  EXPECT_TRUE(same(read_counts(path()), example()));
}

TEST_F(ChainIo, RefusesWhatIsNoFileOfOurs) {
  expect_complaint(path("missing"), "cannot open: No such file");
  expect_complaint(fs::path(path()).parent_path().string(), "not a regular file");
  expect_complaint("/dev/null", "not a regular file");
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  expect_complaint(path("pipe"), "not a regular file");
  put_bytes(path("empty"), "");
  expect_complaint(path("empty"), "not a NetCDF-4 file");
  put_bytes(path("text"), "row,column,count\n1,2,3\n");
  expect_complaint(path("text"), "not a NetCDF-4 file");
  put_bytes(path("classic"), "CDF\x01 crc64-xz:0000000000000000");
  expect_complaint(path("classic"), "not a NetCDF-4 file");
  put_bytes(path("hdf"), std::string("\x89HDF\r\n\x1a\n") + std::string(4000, '\0'));
  expect_complaint(path("hdf"), "holds no checksum");
  put_bytes(path("short"), std::string("\x89HDF\r\n\x1a\n") + "crc64-xz:123");
  expect_complaint(path("short"), "holds no checksum");
  put_bytes(path("stub"), sealed(std::string("\x89HDF\r\n\x1a\n") + "crc64-xz:0123456789abcdef"));
  expect_complaint(path("stub"), "cannot open: cut short or damaged, or not NetCDF-4");
}

// ---- Files with a good checksum and bad content, written here through NetCDF itself ----

struct Variable {
  std::string dimension;
  std::vector<std::int64_t> values;
  nc_type type;
};

// A small file in the layout of markov/formats/counts.h: 2 inputs, 3 outputs.
struct Draft {
  std::map<std::string, std::size_t> dimensions = {
      {"input_state", 2}, {"output_state", 3}, {"nonzero", 4}};
  std::map<std::string, Variable> variables = {
      {"count_row", {"nonzero", {0, 0, 1, 1}, NC_INT}},
      {"count_column", {"nonzero", {0, 2, 1, 2}, NC_INT}},
      {"count", {"nonzero", {5, 7, 1, 2}, NC_INT64}},
      {"trials", {"input_state", {12, 3}, NC_INT64}},
      {"clamped", {"input_state", {0, 3}, NC_INT64}},
      {"exit_next_input", {"output_state", {0, 1, -1}, NC_INT}},
      {"exit_di_x", {"output_state", {0, 1, 0}, NC_INT}},
      {"exit_di_y", {"output_state", {1, 0, 0}, NC_INT}}};
  std::map<std::string, std::string> text = {{"format", "gatewalk transition counts"},
                                             {"checksum", "crc64-xz:0000000000000000"}};
  std::map<std::string, int> numbers = {{"format_version", 1}};
};

void write_draft(const std::string& path, const Draft& draft) {
  int nc = -1;
  const auto ok = [](int rc) { ASSERT_EQ(rc, NC_NOERR) << nc_strerror(rc); };
  ok(nc_create_mem("draft", NC_NETCDF4, 4096, &nc));
  for (const auto& [name, value] : draft.text) {
    ok(nc_put_att_text(nc, NC_GLOBAL, name.c_str(), value.size(), value.data()));
  }
  for (const auto& [name, value] : draft.numbers) {
    ok(nc_put_att_int(nc, NC_GLOBAL, name.c_str(), NC_INT, 1, &value));
  }
  for (const auto& [name, length] : draft.dimensions) {
    int dimension = -1;
    ok(nc_def_dim(nc, name.c_str(), length, &dimension));
  }
  for (const auto& [name, v] : draft.variables) {
    int dimension = -1, variable = -1;
    ok(nc_inq_dimid(nc, v.dimension.c_str(), &dimension));
    ok(nc_def_var(nc, name.c_str(), v.type, 1, &dimension, &variable));
    ok(nc_def_var_deflate(nc, variable, 1, 1, 9));
    if (v.values.empty()) continue;
    const std::size_t first = 0, count = v.values.size();
    const std::vector<long long> numbers(v.values.begin(), v.values.end());
    ok(nc_put_vara_longlong(nc, variable, &first, &count, numbers.data()));
  }
  NC_memio image{};
  ok(nc_close_memio(nc, &image));
  put_bytes(path, sealed(std::string(static_cast<const char*>(image.memory), image.size)));
  std::free(image.memory);
}

TEST_F(ChainIo, ReadsADraftThatFollowsTheLayout) {
  write_draft(path(), {});
  const CountsFile file = read_counts(path());
  EXPECT_EQ(file.counts.rows(), 2);
  EXPECT_EQ(file.counts.cols(), 3);
  EXPECT_EQ(file.counts.coeff(0, 2), 7);
  EXPECT_EQ(file.counts.nonZeros(), 4);
  EXPECT_EQ(file.clamped, (std::vector<std::int64_t>{0, 3}));
  EXPECT_EQ(file.exits, (std::vector<Exit>{{0, 0, 1}, {1, 1, 0}, {}}));
}

TEST_F(ChainIo, RefusesEveryMalformedDraft) {
  const auto refused = [&](const std::string& part, const std::function<void(Draft&)>& spoil) {
    Draft draft;
    spoil(draft);
    write_draft(path(), draft);
    expect_complaint(path(), part);
  };
  const auto value = [](const std::string& name, std::size_t at, std::int64_t number) {
    return [=](Draft& d) { d.variables.at(name).values.at(at) = number; };
  };
  refused("row 0 (counted from 0): counts add up to 13, trials are 12", value("count", 0, 6));
  refused("row 1 (counted from 0): counts add up to 3, trials are 4", value("trials", 1, 4));
  refused("row 1 (counted from 0): count 0 is not positive", value("count", 2, 0));
  refused("row 1 (counted from 0): count -1 is not positive", value("count", 2, -1));
  refused("row 0 (counted from 0): the sum of counts overflows",
          value("count", 0, std::numeric_limits<std::int64_t>::max()));
  refused("row 1 (counted from 0): 4 clamped of 3 trials", value("clamped", 1, 4));
  refused("row 1 (counted from 0): -1 clamped", value("clamped", 1, -1));
  refused("row 0 (counted from 0): column 2 is repeated", value("count_column", 0, 2));
  refused("row 1 (counted from 0): column 1 is repeated or out of order", [](Draft& d) {
    d.variables.at("count_column").values = {0, 2, 2, 1};
  });
  refused("row 0 (counted from 0): column -1 is out of range", value("count_column", 0, -1));
  refused("row 1 (counted from 0): column 3 is out of range", value("count_column", 3, 3));
  refused("count_row: entry 0 (counted from 0), row -1", value("count_row", 0, -1));
  refused("count_row: entry 3 (counted from 0), row 2", value("count_row", 3, 2));
  refused("count_row: entry 2 (counted from 0), row 0", [](Draft& d) {
    d.variables.at("count_row").values = {0, 1, 0, 1};
  });
  refused("exit of output 1 (counted from 0): next_input 2", value("exit_next_input", 1, 2));
  refused("exit of output 1 (counted from 0): next_input -2", value("exit_next_input", 1, -2));
  refused("exit of output 2 (counted from 0): trapped", value("exit_di_x", 2, 1));
  refused("exit of output 2 (counted from 0): trapped", value("exit_di_y", 2, 1));

  const Draft whole;
  for (const auto& entry : whole.variables) {
    const std::string& name = entry.first;
    const std::string& dimension = entry.second.dimension;
    refused("variable " + name, [&](Draft& d) { d.variables.erase(name); });
    refused("variable " + name + ": wrong type",
            [&](Draft& d) { d.variables.at(name).type = NC_SHORT; });
    refused("variable " + name + " does not have the one dimension", [&](Draft& d) {
      d.dimensions["other"] = whole.dimensions.at(dimension);
      d.variables.at(name).dimension = "other";
    });
  }
  refused("dimension input_state", [](Draft& d) {
    d.dimensions.erase("input_state");
    d.dimensions["inputs"] = 2;
    d.variables.at("trials").dimension = d.variables.at("clamped").dimension = "inputs";
  });
  refused("at least one input", [](Draft& d) {
    d.dimensions["input_state"] = 0;
    for (const char* name : {"trials", "clamped"}) d.variables.at(name).values.clear();
    d.dimensions["nonzero"] = 0;
    for (const char* name : {"count", "count_row", "count_column"}) {
      d.variables.at(name).values.clear();
    }
  });
  // More numbers than the bytes of the file can hold, and no data behind them.
  for (const std::size_t length : {std::size_t{100'000'000}, std::size_t{1} << 40}) {
    refused("is absurdly long", [&](Draft& d) {
      d.dimensions["nonzero"] = length;
      for (const char* name : {"count", "count_row", "count_column"}) {
        d.variables.at(name).values.clear();
      }
    });
  }
  refused("format is not", [](Draft& d) { d.text["format"] = "something else"; });
  refused("attribute format", [](Draft& d) { d.text.erase("format"); });
  refused("attribute format is not text", [](Draft& d) {
    d.text.erase("format");
    d.numbers["format"] = 1;
  });
  refused("format_version is 4, this program reads 1 to 3",
          [](Draft& d) { d.numbers["format_version"] = 4; });
  refused("format_version", [](Draft& d) { d.numbers.clear(); });
  refused("format_version is not a number", [](Draft& d) {
    d.numbers.clear();
    d.text["format_version"] = "1";
  });
  refused("attribute seed is not text", [](Draft& d) { d.numbers["seed"] = 1; });
  refused("name \"1st\"", [](Draft& d) { d.text["1st"] = "x"; });
  // A variable of another name must be a NamedArray.
  refused("attribute long_name", [](Draft& d) {
    d.dimensions["extra_length"] = 1;
    d.variables["extra"] = {"extra_length", {1}, NC_DOUBLE};
  });
  refused("more than once", [](Draft& d) { d.text["remark"] = d.text["checksum"]; });
}

// ---- The disk fails ----

TEST_F(ChainIo, WhateverCallFailsTheOldFileOrTheNewOneIsWhole) {
  const CountsFile old_file = example();
  CountsFile new_file = old_file;
  new_file.text["seed"] = "2";
  for (const bool for_ever : {false, true}) {
    int failures = 0;
    for (int k = 1;; ++k) {
      write_counts(path(), old_file);
      disk = {.armed = true, .for_ever = for_ever, .fail_at = k, .most_per_write = 30'000};
      std::string what;
      try {
        write_counts(path(), new_file);
      } catch (const std::runtime_error& error) {
        what = error.what();
      }
      const bool was_reached = disk.calls >= k;
      disk = {};
      EXPECT_EQ(files(), 1) << "left beside it after call " << k << ": " << what;
      const bool is_new = what.empty() || what.find("written, but") != std::string::npos;
      EXPECT_TRUE(same(read_counts(path()), is_new ? new_file : old_file)) << k << ": " << what;
      if (!was_reached) break;
      if (!what.empty()) {
        ++failures;
        EXPECT_EQ(what.rfind(path() + ": ", 0), 0U) << what;
      }
    }
    // 3 writes (64 KB in pieces of 30 000 bytes), sync, close, rename, sync of the folder.
    EXPECT_EQ(failures, 7);
  }
}

TEST_F(ChainIo, AFileMadeInPiecesIsReplacedAsAWholeOrNotAtAll) {
  put_bytes(path("text"), "old");
  const auto make = [&](bool fails) {
    replace_file(path("text"), [&](const WriteBytes& write) {
      write("in ");
      write("");
      if (fails) throw std::invalid_argument("no more");
      write("pieces");
    });
  };
  EXPECT_THROW(make(true), std::invalid_argument);
  EXPECT_EQ(bytes_of(path("text")), "old");
  EXPECT_EQ(files(), 1);
  make(false);
  EXPECT_EQ(bytes_of(path("text")), "in pieces");
  EXPECT_EQ(files(), 1);
}

TEST_F(ChainIo, NeverWritesOverWhatIsNoRegularFile) {
  const auto refused = [&](const std::string& target, const std::string& part) {
    try {
      write_counts(target, example());
      ADD_FAILURE() << target << " written";
    } catch (const std::runtime_error& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.rfind(target + ": ", 0), 0U) << what;
      EXPECT_NE(what.find(part), std::string::npos) << what;
    }
  };
  refused("/dev/full", "No space left on device");
  refused(fs::path(path()).parent_path().string(), "is a directory");
  refused(path("no/such/folder.nc"), "No such file or directory");
  put_bytes(path("file"), "x");
  refused(path("file/counts.nc"), "Not a directory");
  fs::create_symlink("file", path("link"));
  refused(path("link"), "is a symbolic link");
  EXPECT_EQ(bytes_of(path("file")), "x");
  EXPECT_EQ(files(), 2);
}

TEST_F(ChainIo, WritesIntoAPipe) {
  write_counts(path(), example());
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  std::string seen;
  std::thread reader([&] { seen = bytes_of(path("pipe")); });
  write_counts(path("pipe"), example());
  reader.join();
  EXPECT_TRUE(seen == bytes_of(path()));
  EXPECT_EQ(files(), 2);
}

TEST_F(ChainIo, KeepsTheModeOfTheFileItReplaces) {
  const auto mode = [&] { return static_cast<unsigned>(fs::status(path()).permissions()); };
  const mode_t before = ::umask(027);
  write_counts(path(), example());
  ::umask(before);
  EXPECT_EQ(mode(), 0640u);
  ASSERT_EQ(::chmod(path().c_str(), 0600), 0);
  write_counts(path(), example());
  EXPECT_EQ(mode(), 0600u);
}

TEST_F(ChainIo, TakesANameAsLongAsAFileCanHave) {
  write_counts(path(std::string(255, 'n')), example());
  EXPECT_TRUE(same(read_counts(path(std::string(255, 'n'))), example()));
}

// Sparse files: if they were read into memory, the limit below would stop the program.
TEST_F(ChainIo, RefusesALargeFileInConstantMemory) {
  const std::string begin = "\x89HDF\r\n\x1a\n";
  put_bytes(path("zeros"), "");
  fs::resize_file(path("zeros"), 3'000'000'000);
  put_bytes(path("large"), begin);
  fs::resize_file(path("large"), 3'000'000'000);
  put_bytes(path("other"), begin);
  fs::resize_file(path("other"), 500'000'000);
  put_bytes(path("damaged"), begin + "crc64-xz:0123456789abcdef");
  fs::resize_file(path("damaged"), 500'000'000);
  const auto resident = [] {
    rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;  // KB
  };
  const long before = resident();
  expect_complaint(path("zeros"), "not a NetCDF-4 file");
  expect_complaint(path("large"), "more than the 1073741824");
  expect_complaint(path("other"), "holds no checksum");
  expect_complaint(path("damaged"), "checksum does not match");
  EXPECT_LT(resident() - before, 20'000);
}

// A mark that crosses two of the pieces that are read, and a second mark far behind the first.
TEST_F(ChainIo, FindsTheChecksumWhereverItStands) {
  const std::string begin = "\x89HDF\r\n\x1a\n";
  for (int shift = 0; shift < 12; ++shift) {
    std::string bytes = begin;
    bytes.resize(static_cast<std::size_t>(65536 - shift), 'x');
    bytes += "crc64-xz:0000000000000000" + std::string(70'000, 'y');
    put_bytes(path(), sealed(bytes));
    const std::string what = complaint(path());
    EXPECT_EQ(what.find("checksum"), std::string::npos) << what;  // only its content is refused
    put_bytes(path(), sealed(bytes) + "crc64-xz:");
    expect_complaint(path(), "more than once");
  }
}

}  // namespace
}  // namespace gatewalk::markov
