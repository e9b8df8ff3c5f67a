// SPDX-License-Identifier: MIT
// Tables as spreadsheets and other programs write them: read if they are unambiguous, else refused
// with a sentence.
#include "lattice/text/table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/text/csv.h"

namespace gatewalk::lattice {
namespace {

using Rows = std::vector<std::vector<std::string>>;

bool has_a_and_b(const Table::Names& names) {
  return Table::column_in(names, "a") && Table::column_in(names, "b");
}

class TableFile : public testing::Test {
 protected:
  void SetUp() override {
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string("table_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
             ".csv");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  std::string file(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return path_.string();
  }
  /// Columns a and b of all rows.
  Rows rows(const std::string& text) {
    Table table(file(text), has_a_and_b);
    EXPECT_TRUE(table.has_header()) << text;
    Rows all;
    if (!table.has_header()) return all;
    const auto a = table.column("a"), b = table.column("b");
    while (table.next()) all.push_back({std::string(table[*a]), std::string(table[*b])});
    remarks_ = table.remarks();
    return all;
  }
  std::string refusal(const std::string& text) {
    try {
      (void)rows(text);
    } catch (const std::invalid_argument& e) {
      std::string words = e.what();
      return words.replace(0, path_.string().size(), "x");
    }
    return "nothing refused";
  }

  std::filesystem::path path_;
  std::vector<std::string> remarks_;
};

const Rows kPlain{{"1", "2"}, {"3", "4"}};

TEST_F(TableFile, PlainTablesHaveNoRemarks) {
  for (const char* text :
       {"a,b\n1,2\n3,4\n", "a,b\r\n1,2\r\n3,4", "\n# remark\n a , b \n1,2\n\n3,4\n",
        "\xEF\xBB\xBF"
        "a,b\n1,2\n3,4\n",
        "b,z,a\n2,,1\n4,5,3\n", "\"a\",\"b\"\n\"1\",\"2\"\n3,4\n", "a,b\n1,2\n3,4\n,\n \n,\n",
        "a,b\r\r\n1,2\r\r\n3,4\r\r\n", "b,a\n2,1,\n4,3,\n"}) {
    EXPECT_EQ(rows(text), kPlain) << text;
    EXPECT_TRUE(remarks_.empty()) << text;
  }
}

TEST_F(TableFile, SaysWhatItUnderstood) {
  const auto expect = [&](const char* text, const std::vector<std::string>& remarks) {
    EXPECT_EQ(rows(text), kPlain) << text;
    EXPECT_EQ(remarks_, remarks) << text;
  };
  expect("a;b\n1;2\n3;4\n", {"fields are set apart by semicolons"});
  expect("a\tb\n1\t2\n3\t4\n", {"fields are set apart by tabs"});
  expect("a,b\r1,2\r3,4\r", {"lines end in CR alone"});
  expect("video: x\nframes, 60\n\na,b\n1,2\n3,4\n",
         {"the columns are named in line 4; 2 lines before it left out"});
  expect("sep=;\na;b\n1;2\n3;4\n", {"fields are set apart by semicolons",
                                    "the columns are named in line 2; 1 line before it left out"});
  expect("a,b\n\"0\",1,2\n\"1\",3,4\n",
         {"the first column has no name and numbers the rows: left out"});
  expect("a,b,a\n1,2,1\n3,4,3\n", {"columns 1 and 3 are both named a, with the same content"});
  expect("# a b\n#a,b\n1,2\n3,4\n", {});  // numpy.savetxt
  // Concatenated files.
  expect("a,b\n1,2\na,b\n3,4\n", {"1 more line names the columns: left out"});
  expect("a,b\n1,2\n#5,6\n3,4\n", {"1 line that begins with # and may be a row: left out"});
  expect("a,b,a\n1,2,1.0\n3,4,3\n", {"columns 1 and 3 are both named a, with the same content"});
  expect("A,B\n1,2\n3,4\n", {});               // upper and lower case do not matter
  expect("\"x\ny\",a,b\n0,1,2\n0,3,4\n", {});  // a name of two lines
}

TEST_F(TableFile, FieldsInQuotationMarksMayHaveLineEnds) {
  EXPECT_EQ(rows("a,b\n\"1\n,\"\"\",2\n3,4\n"), (Rows{{"1\n,\"", "2"}, {"3", "4"}}));
}

TEST_F(TableFile, RefusesWhatIsAmbiguous) {
  EXPECT_EQ(
      refusal("a,b\n0,2,3\n1,3,4\n"),
      "x:2: has 3 fields, the line of the columns (line 1) has 2 (are there names of rows? Name "
      "their column, or write none)");
  EXPECT_EQ(refusal("a,b\n\"1\",5,6\n\"3\",7,8\n"),
            "x:3: has 3 fields, the line of the columns (line 1) has 2 behind the number of the "
            "row");
  EXPECT_NE(refusal("a,b\n\"1\",2,\n\"2\",3,\n").find("does the first number the rows"),
            std::string::npos);
  EXPECT_EQ(refusal("a,b\n1,2\n3\n"), "x:3: has 1 field, the line of the columns (line 1) has 2");
  EXPECT_EQ(refusal("a,b,a\n1,2,1\n1,2,0\n"),
            "x:3: columns 1 and 3 are both named \"a\" and differ: \"1\", \"0\": give one of them "
            "another name");
  EXPECT_EQ(refusal("a,b\n1,\"2\n3,4\n"), "x:2: a quotation mark is not closed");
  EXPECT_EQ(refusal("a,b\n1,\"2\"3\n"),
            "x:2: a quotation mark is not closed, or not at a field's end");
  EXPECT_EQ(refusal("a,b\n1,2\r3,4\n"),
            "x:2: a carriage return within a line: lines must end in \\n or \\r\\n, or all in \\r");
}

TEST_F(TableFile, NumbersHaveDecimalPointsOrCommas) {
  const auto sum = [&](const std::string& text) {
    Table table(file(text), has_a_and_b);
    double all = 0.0;
    while (table.next()) all += table.number(table[0]).value() + table.number(table[1]).value();
    remarks_ = table.remarks();
    return all;
  };
  EXPECT_EQ(sum("a;b\n1,5;-2,25\n3;1e1\n"), 12.25);
  EXPECT_EQ(remarks_, (std::vector<std::string>{"fields are set apart by semicolons",
                                                "numbers have decimal commas"}));
  EXPECT_EQ(sum("a,b\n\"1,5\",\"2,5\"\n"), 4.0);
  EXPECT_EQ(sum("a;b\n1,016;2,5\n"), 3.516);
  EXPECT_EQ(sum("a,b\n\"0,125\",1\n"), 1.125);
  EXPECT_THROW((void)sum("a,b\n1,\"1,016\"\n"), std::invalid_argument);  // could be a thousand
  EXPECT_EQ(sum("a;b\n1.5;+2.5\n"), 4.0);
  EXPECT_THROW((void)sum("a;b\n1.5;2,5\n"), std::invalid_argument);
  EXPECT_THROW((void)sum("a;b\n1,5;2.5\n"), std::invalid_argument);
  Table table(file("a,b\n1,2\n"), has_a_and_b);
  ASSERT_TRUE(table.next());
  for (const char* none : {"x", "1.234,5", "1,2,3", "1 2", "0x1", "--1", "+-1", ","})
    EXPECT_FALSE(table.number(none)) << none;
  for (const char* nothing :
       {"", "NA", "None", "null", "<NA>", "N/A", "#N/A", "NaN", "nan", "-", "inf", "-Inf",
        "Infinity", "#DIV/0!", "-1.#IND", "-nan(ind)", "missing"})
    EXPECT_TRUE(table.number(nothing) && std::isnan(*table.number(nothing))) << nothing;
}

TEST_F(TableFile, WholeNumbersMayHaveADecimalZero) {
  EXPECT_EQ(Table::whole("12"), 12);
  EXPECT_EQ(Table::whole("+12.0"), 12);
  EXPECT_EQ(Table::whole("-3"), -3);
  EXPECT_EQ(Table::whole("1e+05"), 100'000);  // as R writes it
  for (const char* none : {"", "1.5", "1.00", "1.000", "1,0", "1e-1", "1.5e3", "1e300", "NaN"})
    EXPECT_FALSE(Table::whole(none)) << none;  // 1.000 is a thousand in some countries
}

TEST_F(TableFile, NamesWhatItHasWhereAColumnIsMissing) {
  const auto words = [&](const std::string& text) {
    return Table(file(text), has_a_and_b).column_words();
  };
  EXPECT_EQ(words("x;y;z\n1;2;3\n"), "x, y, z");
  EXPECT_EQ(words("x y\n1 2\n"),
            "x y (fields must be set apart by commas, semicolons or tabs, not by blanks)");
  EXPECT_EQ(words("1,2.5\n3,4\n"),
            "1, 2.5 (these are numbers: the first line must name the columns)");
  std::string many = "c0";
  for (int i = 1; i < 200; ++i) many += ",c" + std::to_string(i);
  EXPECT_LT(words(many + "\n").size(), 250U);
  EXPECT_NE(words(many + "\n").find("(200 in all)"), std::string::npos);
}

TEST_F(TableFile, NamesWhatIsNoText) {
  const auto expect = [&](const std::string& bytes, const std::string& words) {
    EXPECT_NE(refusal(bytes).find(words), std::string::npos) << refusal(bytes);
  };
  using namespace std::string_literals;
  expect(
      "\xFF\xFE"
      "a\0,\0"s,
      "UTF-16");
  expect("a\0,\0b\0"s, "bytes of 0");
  expect("PK\x03\x04zip", ".xlsx");
  expect("\x1F\x8B\x08", "gunzip");
  expect(" <?xml version=\"1.0\"?>", "XML");
  expect("\x89HDF\r\n", "HDF5");
  expect("\x93NUMPY", "numpy");
  expect("{\"a\": 1}", "JSON");
  expect("MATLAB 5.0 MAT-file", "writetable");
  expect("PAR1\x15\x04", "Parquet");
  EXPECT_EQ(no_text("PAR1,a\n"), "");
  expect("\x80\x04\x95", "pickle");
  EXPECT_EQ(no_text("a,b\n1,2\n"), "");
}

TEST_F(TableFile, FindsAHeaderInTheFirstLinesOnly) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += "line\n";
  EXPECT_FALSE(Table(file(text + "a,b\n1,2\n"), has_a_and_b).has_header());
  EXPECT_TRUE(Table(file(text.substr(0, 5 * 199) + "a,b\n1,2\n"), has_a_and_b).has_header());
  EXPECT_TRUE(Table(file(""), has_a_and_b).columns().empty());
}

}  // namespace
}  // namespace gatewalk::lattice
