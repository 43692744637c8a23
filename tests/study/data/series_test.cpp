#include "study/data/series.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/error.h"
#include "tests/temporary_folder.h"

namespace {

using faba::test::TemporaryFolder;

/// A temporary file; deleted with this object.
class CsvFile {
 public:
  explicit CsvFile(const std::string& content) : folder_("series"), path_(folder_.path() / "series.csv") {
    std::ofstream(path_, std::ios::binary) << content;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

/// The error thrown by read_series(): `where` and the full message.
struct Caught {
  std::string where, message;
};
Caught error_of(const std::filesystem::path& path) {
  try {
    static_cast<void>(faba::read_series(path));
  } catch (const faba::Error& e) {
    CHECK(e.code() == faba::Errc::input);
    return {e.where(), e.what()};
  }
  return {"", "no exception"};
}

}  // namespace

TEST_CASE("series: columns are read by name without rounding, in any order") {
  const CsvFile file(
      "t_s,frame,distance_px\n0,0,312.5\n0.066666666666666666,1,0.1\n0.13333333333333333,2,-2e-3\n");
  const faba::Series s = faba::read_series(file.path());
  REQUIRE(s.size() == 3);
  CHECK(s.names() == std::vector<std::string>{"t_s", "frame", "distance_px"});
  CHECK(s.column("t_s")[1] == 0.066666666666666666);
  CHECK(s.column("frame")[2] == 2);
  CHECK(s.column("distance_px")[2] == -2e-3);
  CHECK(s.has("frame"));
  CHECK_FALSE(s.has("limited"));
  CHECK(s.find("limited").empty());
  CHECK_FALSE(s.last_line_cut());
  CHECK(s.location(1) == file.path().string() + ":3");
}

TEST_CASE("series: empty fields and nan are NaN; spaces, CRLF and a byte-order mark are ignored") {
  const CsvFile file(
      "\xEF\xBB\xBF"
      "t_s, setpoint_x_px ,setpoint_y_px\r\n0, 12.5 ,\r\n1,nan,NaN\r\n");
  const faba::Series s = faba::read_series(file.path());
  REQUIRE(s.size() == 2);
  CHECK(s.column("t_s")[1] == 1);
  CHECK(s.column("setpoint_x_px")[0] == 12.5);
  CHECK(std::isnan(s.column("setpoint_y_px")[0]));
  CHECK(std::isnan(s.column("setpoint_x_px")[1]));
  CHECK(std::isnan(s.column("setpoint_y_px")[1]));
}

TEST_CASE("series: an incomplete last line is dropped and reported, even if it looks complete") {
  for (const std::string& rest : {std::string("2"), std::string("2,"), std::string("2,1.2"),
                                  std::string("2,1.25e"), std::string(512, '\0')}) {
    const CsvFile file("frame,t_s\n0,0.5\n1,1.5\n" + rest);
    const faba::Series s = faba::read_series(file.path());
    CHECK(s.size() == 2);
    CHECK(s.last_line_cut());
    CHECK(s.column("t_s")[1] == 1.5);
  }
}

TEST_CASE("series: a header alone is a run without frames") {
  const CsvFile file("frame,t_s\n");
  const faba::Series s = faba::read_series(file.path());
  CHECK(s.size() == 0);
  CHECK(s.has("t_s"));
  CHECK_FALSE(s.last_line_cut());
}

TEST_CASE("series: errors name the file, the line and the reason") {
  SUBCASE("no such file") {
    const Caught e = error_of("no-such-folder/series.csv");
    CHECK(e.where == "no-such-folder/series.csv");
  }
  SUBCASE("a directory") { CHECK(error_of(".").message.find("directory") != std::string::npos); }
  SUBCASE("an empty file") { CHECK(error_of(CsvFile("").path()).message.find("empty") != std::string::npos); }
  SUBCASE("a truncated header") {
    const CsvFile file("frame,t_s,centro");
    CHECK(error_of(file.path()).where == file.path().string() + ":1");
  }
  SUBCASE("not a number, in the third line") {
    const CsvFile file("frame,t_s\n0,0\n1,fast\n");
    const Caught e = error_of(file.path());
    CHECK(e.where == file.path().string() + ":3");
    CHECK(e.message.find("\"fast\"") != std::string::npos);
    CHECK(e.message.find("t_s") != std::string::npos);
  }
  SUBCASE("malformed numbers and infinity") {
    for (const char* bad : {"1.5x", "1.5 2", "0x10", "inf", "-inf", "1e999", "--1", "1,5"}) {
      const CsvFile file(std::string("t_s\n") + bad + "\n0\n");
      CHECK_MESSAGE(error_of(file.path()).where == file.path().string() + ":2", bad);
    }
  }
  SUBCASE("one field too few, one too many, an empty line") {
    for (const char* bad : {"1", "1,2,3", ""}) {
      const CsvFile file(std::string("frame,t_s\n0,0\n") + bad + "\n2,2\n");
      CHECK_MESSAGE(error_of(file.path()).where == file.path().string() + ":3", bad);
    }
  }
  SUBCASE("duplicate and empty names") {
    CHECK(error_of(CsvFile("t_s,t_s\n0,0\n").path()).message.find("duplicate") != std::string::npos);
    CHECK(error_of(CsvFile("t_s,,x\n0,0,0\n").path()).message.find("no name") != std::string::npos);
  }
}

TEST_CASE("series: the error for a missing column names the file and the columns") {
  const faba::Series s("run/series.csv", {"frame", "t_s"}, {{0}, {0}});
  try {
    static_cast<void>(s.column("distance_px"));
    FAIL("no error");
  } catch (const faba::Error& e) {
    CHECK(e.code() == faba::Errc::input);
    CHECK(e.where() == "run/series.csv:1");
    CHECK(std::string(e.what()).find("distance_px") != std::string::npos);
    CHECK(std::string(e.what()).find("frame, t_s") != std::string::npos);
  }
}

TEST_CASE("series: columns must have equal lengths and one name each") {
  CHECK_THROWS_AS(faba::Series("s", {"a", "b"}, {{1}, {1, 2}}), faba::Error);
  CHECK_THROWS_AS(faba::Series("s", {"a"}, {{1}, {1}}), faba::Error);
}
