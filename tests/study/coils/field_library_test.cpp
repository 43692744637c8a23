// Building a field library: its entries, and resuming a stopped build.
#include <doctest/doctest.h>

#include <cmath>

#include "app/files/library_file.h"
#include "app/scenario/rig_file.h"
#include "core/error.h"
#include "core/file.h"
#include "field/null.h"
#include "study/coils/field_library.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

const std::filesystem::path kRig = FABA_SCENES "/../rigs/thesis-four-coils.toml";

FieldLibraryOptions small() {
  FieldLibraryOptions o;
  o.levels = 12;
  o.spacing = 2e-4;
  o.threads = 2;
  return o;
}

void check_equal(const FieldLibrary& a, const FieldLibrary& b) {
  REQUIRE(a.entries().size() == b.entries().size());
  for (std::size_t i = 0; i < a.entries().size(); ++i) {
    CHECK(a.entries()[i].current == b.entries()[i].current);
    CHECK(a.entries()[i].zero == b.entries()[i].zero);
    CHECK(a.entries()[i].gradient == b.entries()[i].gradient);
    CHECK(a.field(i) == b.field(i));
  }
}

}  // namespace

TEST_CASE("field library: every entry is a zero that traps, and its field is that of the coil system") {
  const test::TemporaryFolder f("library");
  const FieldLibrarySummary made = build_field_library(kRig, f.path() / "l.h5", small());
  const auto library = open_library(f.path() / "l.h5");
  const FieldLibrary& l = *library;
  const auto rig = read_rig(kRig, builtin_parts());
  const auto field = rig.make({});
  CHECK_NOTHROW(l.table(*field, coil_system_hash(rig.resolved)));
  REQUIRE(l.entries().size() == made.entries);
  REQUIRE(l.entries().size() > 20);
  const double best = -null_at(*field, {}, 1, current_limits(*field)).gradient[1];
  for (std::size_t i = 0; i < l.entries().size(); ++i) {
    const LibraryEntry& e = l.entries()[i];
    CHECK(std::fabs(e.zero.x) <= 1e-3);
    CHECK(std::fabs(e.zero.y) <= 1e-3);
    const Vec3 b = field->at({e.zero.x, e.zero.y, 0}, e.current);
    CHECK(norm(Vec2{b.x, b.y}) < 1e-12);
    CHECK(std::max(-e.gradient[1], e.gradient[0]) >= 0.5 * best);
    double most = 0;
    for (const double a : e.current) most = std::max(most, std::fabs(a));
    CHECK(most == doctest::Approx(0.5));
    const Vec3 corner = field->at({-1e-3, -1e-3, 0}, e.current);
    CHECK(l.field(i)[0] == doctest::Approx(corner.x).epsilon(1e-6));
    CHECK(l.field(i)[1] == doctest::Approx(corner.y).epsilon(1e-6));
  }
  CHECK_THROWS_AS(build_field_library(kRig, f.path() / "l.h5", small()), Error);  // the file exists
}

TEST_CASE(
    "field library: a stopped or crashed build resumes to the same library, with any number of threads") {
  const test::TemporaryFolder f("library");
  FieldLibraryOptions o = small();
  build_field_library(kRig, f.path() / "complete.h5", o);
  const auto out = f.path() / "stopped.h5", part = f.path() / "stopped.h5.part";
  int asked = 0;
  o.threads = 1;
  o.stop = [&] { return ++asked > 7; };
  try {
    build_field_library(kRig, out, o);
    FAIL("the build was not stopped");
  } catch (const Error& e) {
    CHECK(e.code() == Errc::interrupted);
  }
  CHECK_FALSE(std::filesystem::exists(out));
  CHECK_FALSE(std::filesystem::exists(f.path() / "stopped.h5.lock"));
  REQUIRE(std::filesystem::exists(part));
  const std::string left = read_file(part);
  std::uint64_t first = 0;
  o.stop = [] { return false; };
  o.progress = [&](std::uint64_t done, std::uint64_t) { first = first ? first : done; };
  build_field_library(kRig, out, o);
  CHECK(first > 0);  // it did not restart
  check_equal(*open_library(f.path() / "complete.h5"), *open_library(out));

  // A power failure leaves any part of the file: everything readable is used.
  for (const double fraction : {0.1, 0.5, 0.9}) {
    const auto cut = f.path() / "cut.h5";
    write_file(cut.string() + ".part", left.substr(0, std::size_t(fraction * double(left.size()))));
    o.force = true;
    o.progress = [](auto, auto) {};
    build_field_library(kRig, cut, o);
    check_equal(*open_library(f.path() / "complete.h5"), *open_library(cut));
  }
}

TEST_CASE("field library: options out of range are refused") {
  const test::TemporaryFolder f("library");
  FieldLibraryOptions o = small();
  o.levels = 100000;
  CHECK_THROWS_AS(build_field_library(kRig, f.path() / "l.h5", o), Error);
  o = small();
  o.spacing = 1e-9;
  CHECK_THROWS_AS(build_field_library(kRig, f.path() / "l.h5", o), Error);
  o = small();
  o.width = o.height = 0.05;
  o.spacing = 1e-3;  // contains the coils
  CHECK_THROWS_AS(build_field_library(kRig, f.path() / "l.h5", o), Error);
}
