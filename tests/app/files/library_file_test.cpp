// The file of a field library, and the selection of entries.
#include "app/files/library_file.h"

#include <doctest/doctest.h>

#include "tests/field/field_of.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

const TableGrid kGrid{{-1e-3, -1e-3}, 5e-4, 5, 5};

LibraryEntry entry(double x, double y, double least, double most, double current) {
  return {{current, 2 * current}, {x, y}, {least, most}};
}

struct Written {
  test::TemporaryFolder folder{"library"};
  std::filesystem::path file = folder.path() / "l.h5";
  explicit Written(const std::vector<LibraryEntry>& entries) {
    LibraryWriter w(file, "a rig", "a task", kGrid, 2);
    for (std::size_t i = 0; i < entries.size(); ++i)
      w.add(10 * i, entries[i], std::vector<float>(2 * kGrid.nodes(), float(i)));
    w.finish();
  }
};

}  // namespace

TEST_CASE("library: written entries are read back; the file has its final name only when complete") {
  const Written w({entry(1e-4, 2e-4, -2, -1, 0.25), entry(-3e-4, 0, 1, 3, -0.5)});
  const auto kept_l = open_library(w.file);
  const FieldLibrary& l = *kept_l;
  REQUIRE(l.entries().size() == 2);
  CHECK(l.entries()[1].current == std::vector<double>{-0.5, -1});
  CHECK(l.entries()[1].zero == Vec2{-3e-4, 0});
  CHECK(l.entries()[0].gradient == std::array<double, 2>{-2, -1});
  CHECK(l.grid().columns == 5);
  CHECK(l.grid().spacing == 5e-4);
  CHECK(l.field(1) == std::vector<float>(50, 1.0f));
  CHECK(library_task(w.file) == "a task");
  CHECK_FALSE(std::filesystem::exists(w.file.string() + ".part"));
}

TEST_CASE(
    "library: the nearest zero that traps cells of the polarity; of two equal ones that with less power") {
  const Written w({entry(0, 0, -2, -1, 0.5), entry(0, 0, -1, -0.5, 0.25), entry(0, 0, 1, 2, -0.5),
                   entry(1e-4, 0, -2, -1, 0.4), entry(0, 1e-5, -2, 1, 0.1), entry(5e-4, 5e-4, 0.5, 1, -0.1)});
  const auto kept_l = open_library(w.file);
  const FieldLibrary& l = *kept_l;
  CHECK(l.nearest({1e-5, 0}, 1) == 1);  // neither the nearby saddle nor the larger current
  CHECK(l.nearest({0.9e-4, 0}, 1) == 3);
  CHECK(l.nearest({0, 0}, -1) == 2);
  CHECK(l.nearest({1, 1}, -1) == 5);
}

TEST_CASE(
    "library: with saddles only, those that trap more than they drive away; an empty library has no nearest "
    "zero") {
  const Written saddles({entry(0, 0, -2, 1, 0.5), entry(0, 0, -1, 2, -0.5)});
  const auto kept_l = open_library(saddles.file);
  const FieldLibrary& l = *kept_l;
  CHECK(l.nearest({0, 0}, 1) == 0);
  CHECK(l.nearest({0, 0}, -1) == 1);
  const Written none({});
  CHECK_FALSE(open_library(none.file)->nearest({0, 0}, 1).has_value());
}

TEST_CASE("library: entries written before a crash are imported, for the same task only") {
  test::TemporaryFolder folder("library");
  const auto file = folder.path() / "l.h5";
  const std::vector<float> field(2 * kGrid.nodes(), 7);
  {
    LibraryWriter w(file, "a rig", "a task", kGrid, 2);
    w.add(3, entry(1e-4, 0, -2, -1, 1), field);
    w.add(8, entry(2e-4, 0, -2, -1, 1), field);
    w.tried(12);  // no finish(): the files are those after a crash
  }
  CHECK_FALSE(std::filesystem::exists(file));
  {
    LibraryWriter w(file, "a rig", "a task", kGrid, 2);
    CHECK(w.done() == 12);
    CHECK(w.entries() == 2);
  }
  LibraryWriter w(file, "a rig", "another task", kGrid, 2);
  CHECK(w.done() == 0);
  CHECK(w.entries() == 0);
}

TEST_CASE("library: another coil system is rejected, by its hash and by its field") {
  const auto rig_with = [](const std::string& radius) {
    return field_of("type = 'rig'\n[[coil]]\ntype = 'loop'\nposition = [0, 0, 0.02]\nradius = " + radius +
                    "\n[[coil]]\ntype = 'loop'\nposition = [0, 0.02, 0]\n");
  };
  const auto rig = rig_with("0.005"), other = rig_with("0.0051");
  test::TemporaryFolder folder("library");
  const auto file = folder.path() / "l.h5";
  FieldTable table(*rig, kGrid);
  const LibraryEntry e = entry(0, 0, -2, -1, 0.5);
  table.set(e.current);
  LibraryWriter w(file, "this rig", "a task", kGrid, 2);
  w.add(0, e, table.nodes());
  w.finish();
  const auto kept_l = open_library(file);
  const FieldLibrary& l = *kept_l;
  CHECK_NOTHROW(l.table(*rig, "this rig"));
  CHECK_THROWS_AS(l.table(*rig, "that rig"), Error);
  CHECK_THROWS_AS(l.table(*other, "this rig"), Error);
}
