#include "server/files/trash.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;
namespace fs = std::filesystem;

namespace {

/// A workspace with the run runs/one of 1500 bytes, and its scenario beside it.
struct Lab {
  test::TemporaryFolder folder{"trash"};
  fs::path root = folder.path() / "lab";
  Workspace workspace;

  Lab() : workspace(made(root), {}) {}
  static const fs::path& made(const fs::path& root) {
    fs::create_directories(root / "runs/one/pictures");
    write_file(root / "runs/one/series.csv", std::string(1000, 'x'));
    write_file(root / "runs/one/pictures/a.png", std::string(500, 'x'));
    write_file(root / "runs/one.toml", std::string(20, 'x'));
    return root;
  }
  fs::path trash() const { return root / ".faba-trash"; }
};

std::size_t count(const fs::path& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("a deleted run is restored with all files") {
  const Lab lab;
  Trash trash(lab.workspace);
  CHECK_FALSE(fs::exists(lab.trash()));
  const Trash::Item item = trash.take("runs/one", {"runs/one.toml", "runs/absent.toml"});
  CHECK(item.name == "runs/one");
  CHECK(item.bytes == 1520);
  CHECK_FALSE(fs::exists(lab.root / "runs/one"));
  CHECK_FALSE(fs::exists(lab.root / "runs/one.toml"));
  REQUIRE(trash.items().size() == 1);
  CHECK(trash.items()[0].id == item.id);

  CHECK(trash.undo(item.id).bytes == 1520);
  CHECK(read_file(lab.root / "runs/one/pictures/a.png").size() == 500);
  CHECK(read_file(lab.root / "runs/one.toml").size() == 20);
  CHECK(trash.items().empty());
  CHECK_THROWS_WITH_AS(trash.undo(item.id), doctest::Contains("is not a deletion that can be undone"),
                       const Error&);
}

TEST_CASE("what belongs to a deletion is restored after its files, or nothing is") {
  const Lab lab;
  Trash trash(lab.workspace);
  int calls = 0;
  bool refuses = true;
  const Trash::Item item = trash.take("runs/one", {"runs/one.toml"}, [&] {
    ++calls;
    CHECK(fs::exists(lab.root / "runs/one/series.csv"));
    if (refuses) throw Error(Errc::input, "x", "gone");
  });
  CHECK_THROWS_WITH_AS(trash.undo(item.id), "x: gone", const Error&);
  CHECK_FALSE(fs::exists(lab.root / "runs/one"));
  CHECK_FALSE(fs::exists(lab.root / "runs/one.toml"));
  REQUIRE(trash.items().size() == 1);
  refuses = false;
  trash.undo(item.id);
  CHECK(calls == 2);
  CHECK(fs::exists(lab.root / "runs/one.toml"));
  CHECK(trash.items().empty());
}

TEST_CASE("undo is refused while the name is used again, and nothing is moved") {
  const Lab lab;
  Trash trash(lab.workspace);
  const int id = trash.take("runs/one", {"runs/one.toml"}).id;
  // An empty folder could be replaced by rename(), a folder with files could not.
  fs::create_directories(lab.root / "runs/one");
  CHECK_THROWS_WITH_AS(trash.undo(id), doctest::Contains("the name is used again"), const Error&);
  fs::remove(lab.root / "runs/one");
  write_file(lab.root / "runs/one.toml", "new");
  CHECK_THROWS_WITH_AS(trash.undo(id), doctest::Contains("runs/one.toml"), const Error&);
  CHECK_FALSE(fs::exists(lab.root / "runs/one"));
  CHECK(read_file(lab.root / "runs/one.toml") == "new");
  fs::remove(lab.root / "runs/one.toml");
  trash.undo(id);
  CHECK(fs::exists(lab.root / "runs/one/series.csv"));
}

TEST_CASE("a name can be deleted several times, and a file of an experiment as well") {
  const Lab lab;
  Trash trash(lab.workspace);
  const int first = trash.take("runs/one").id;
  fs::create_directories(lab.root / "runs/one");
  write_file(lab.root / "runs/one/series.csv", "second");
  const Trash::Item second = trash.take("runs/one");
  CHECK(second.bytes == 6);
  CHECK(second.id != first);
  CHECK(trash.take("runs/one.toml").bytes == 20);
  fs::remove(lab.root / "runs");  // is created again
  trash.undo(second.id);
  CHECK(read_file(lab.root / "runs/one/series.csv") == "second");
}

TEST_CASE("links are neither deleted nor followed") {
  const Lab lab;
  fs::create_directories(lab.folder.path() / "outside");
  write_file(lab.folder.path() / "outside/kept.txt", std::string(4000, 'x'));
  fs::create_directories(lab.root / "data");
  write_file(lab.root / "data/kept.txt", "x");
  fs::create_symlink(lab.folder.path() / "outside", lab.root / "runs/one/link");
  fs::create_symlink(lab.root / "data", lab.root / "runs/same");
  fs::create_symlink(lab.folder.path() / "outside", lab.root / "runs/out");
  {
    Trash trash(lab.workspace);
    CHECK_THROWS_WITH_AS(trash.take("runs/same"), doctest::Contains("is a link"), const Error&);
    for (const char* bad :
         {"runs/out", "runs/out/kept.txt", "../lab/runs/one", "runs/../runs/one", "/etc", ""})
      CHECK_THROWS_AS(trash.take(bad), const Error&);
    CHECK_THROWS_WITH_AS(trash.take("runs/none"), doctest::Contains("not found"), const Error&);
    CHECK(trash.take("runs/one").bytes == 1500);
  }
  CHECK(fs::exists(lab.folder.path() / "outside/kept.txt"));
  CHECK(fs::exists(lab.root / "data/kept.txt"));
  CHECK_FALSE(fs::exists(lab.trash()));
}

TEST_CASE("pages cannot access deleted files") {
  const Lab lab;
  Trash trash(lab.workspace);
  trash.take("runs/one");
  const fs::path kept = fs::directory_iterator(lab.trash())->path() / "1/0/series.csv";
  REQUIRE(fs::exists(kept));
  const std::string name = fs::relative(kept, lab.root).string();
  fs::create_symlink(lab.trash(), lab.root / "runs/trash");
  for (const std::string& asked : {name, "runs/../" + name, "runs/trash" + name.substr(name.find('/'))}) {
    INFO(asked);
    CHECK_THROWS_AS(lab.workspace.inside(asked), const Error&);
    CHECK_THROWS_AS(lab.workspace.check_files({{"file", asked}}), const Error&);
  }
  CHECK_THROWS_AS(trash.take(".faba-trash"), const Error&);
}

TEST_CASE("the trash is emptied when the lab ends, and after a killed lab at the next start") {
  const Lab lab;
  int ready[2];
  REQUIRE(pipe(ready) == 0);
  const pid_t child = fork();
  if (child == 0) {
    // Not destroyed: the process is killed.
    auto* trash = new Trash(lab.workspace);
    trash->take("runs/one");
    (void)!write(ready[1], "x", 1);
    for (;;) pause();
  }
  char c = 0;
  REQUIRE(read(ready[0], &c, 1) == 1);
  REQUIRE(count(lab.trash()) == 1);
  {
    Trash other(lab.workspace);
    CHECK(count(lab.trash()) == 1);  // the other lab is running
    CHECK(other.items().empty());
    other.take("runs/one.toml");
    CHECK(count(lab.trash()) == 2);
    const Trash third(lab.workspace);  // of this process
    CHECK(count(lab.trash()) == 2);
  }
  CHECK(count(lab.trash()) == 1);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  write_file(lab.trash() / "notes.txt", "not of a lab");
  { const Trash next(lab.workspace); }
  CHECK(count(lab.trash()) == 1);
  CHECK(fs::exists(lab.trash() / "notes.txt"));
  close(ready[0]);
  close(ready[1]);
}

TEST_CASE("a link in place of the folder of the trash is refused") {
  const Lab lab;
  fs::create_directories(lab.folder.path() / "outside/1-1");
  fs::create_symlink(lab.folder.path() / "outside", lab.trash());
  CHECK_THROWS_WITH_AS(Trash(lab.workspace), doctest::Contains("is not a folder"), const Error&);
  CHECK(fs::exists(lab.folder.path() / "outside/1-1"));
}
