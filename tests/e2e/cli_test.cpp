#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/h5/h5.h"
#include "tests/e2e/program.h"

using namespace faba;

TEST_CASE("help, version, parts, schema and doctor answer with exit 0") {
  const TestFolder f;
  CHECK(faba_in(f.path, "--version").out == "faba " FABA_VERSION "\n");
  for (const char* verb :
       {"--help", "run --help", "resume --help", "drop --help", "parts --help", "schema --help", "doctor"}) {
    const Called c = faba_in(f.path, verb);
    INFO(verb);
    CHECK(c.exit == 0);
    CHECK(c.err.empty());
    CHECK(c.out.size() > 40);
  }
  CHECK(faba_in(f.path, "run --help").out.find("Examples:") != std::string::npos);
  CHECK(faba_in(f.path, "rig capture --help").out.find("(records until Ctrl-C)") != std::string::npos);
  CHECK(faba_in(f.path, "parts --json").json()["model"].contains("dipole"));
  CHECK(faba_in(f.path, "parts model dipole --json").json()["properties"]["speed"]["x-unit"] == "m/s");
  CHECK(faba_in(f.path, "schema").json()["properties"]["swarm"]["type"] == "array");
  CHECK(faba_in(f.path, "rig list").out.find("driver \"simulated\" and \"none\"") != std::string::npos);
  CHECK(faba_in(f.path, "doctor --json").json().contains("threads"));
  CHECK(faba_in(f.path, "doctor").out.find("free disk space ") != std::string::npos);
  CHECK(faba_in(f.path, "lab --www nope").err.find("--www: folder nope not found") != std::string::npos);
}

TEST_CASE("the list of parts has two spaces at least between a name and its text") {
  const TestFolder f;
  std::istringstream lines(faba_in(f.path, "parts").out);
  std::size_t parts = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  ")) continue;
    INFO(line);
    const std::size_t end = line.find(' ', 2);
    REQUIRE(end != std::string::npos);
    CHECK(line.substr(end, 2) == "  ");
    ++parts;
  }
  CHECK(parts > 30);
}

TEST_CASE("the help states defaults and ranges in words") {
  const TestFolder f;
  const auto help = [&](const char* verb) { return faba_in(f.path, std::string(verb) + " --help").out; };
  const std::pair<const char*, const char*> stated[] = {
      {"run", "--threads INT, 1 to 1024"},
      {"run", "--seed INT"},
      {"rig jog", "--seed INT"},
      {"rig jog", "default: \"50 mA\""},
      {"track", "--memory INT, 0 to 1000"},
      {"track", "Minimum number of detections of a track; default: 3"},
      {"distance", "default: 0.9"},
      {"compare", "default: 0.9"},
      {"field library", "default: \"2 mm, 2 mm\""},
      {"field null", "default: north"},
      {"flow", "(horn_schunck, default: multigrid)"},
      {"flow", "other options override it"},
      {"flow", "(horn_schunck, default: 0.001 px)"},
      {"flow", "(farneback, default: 15 px)"},
      {"rig capture", "--frames INT, at least 1"},
      {"activity", "(horn_schunck, default: jacobi)"},
      {"compare", "(horn_schunck, default: jacobi)"},
      {"compare", "(horn_schunck, default: published)"}};
  for (const auto& [verb, text] : stated) {
    INFO(verb, ": ", text);
    CHECK(help(verb).find(text) != std::string::npos);
  }
  for (const char* verb : {"run", "lab", "track", "flow", "field library", "rig capture", "identify"}) {
    const std::string text = help(verb);
    CHECK(text.find("UINT") == std::string::npos);
    CHECK(text.find("INT in [") == std::string::npos);
  }
}

TEST_CASE("schema series lists the columns that a run writes") {
  const TestFolder f;
  write_file(f.path / "scene.toml", kSmallScene);
  REQUIRE(faba_in(f.path, "run scene.toml --seed 1 --duration '0 s' --out run").exit == 0);
  const std::string csv = read_file(f.path / "run/series.csv");
  const auto columns = faba_in(f.path, "schema series --json").json()["columns"];
  std::string header;
  for (const auto& one : columns) {
    const auto name = one["name"].get<std::string>();
    CHECK(!one["meaning"].get<std::string>().empty());
    if (name == "current_K_a") continue;  // a column for each coil
    header += (header.empty() ? "" : ",") + name;
  }
  std::string written = csv.substr(0, csv.find('\n'));
  for (std::size_t at; (at = written.find("current_")) != std::string::npos;)
    written.erase(at, written.find(',', at) + 1 - at);
  CHECK(header == written);

  const Called text = faba_in(f.path, "schema series");
  CHECK(text.exit == 0);
  CHECK(std::count(text.out.begin(), text.out.end(), '\n') == std::ptrdiff_t(columns.size()));
  CHECK(text.out.find("current_K_a") != std::string::npos);
}

TEST_CASE("help is also a verb, and the next command printed by run works") {
  const TestFolder f;
  CHECK(faba_in(f.path, "help").out == faba_in(f.path, "--help").out);
  CHECK(faba_in(f.path, "help drop").out == faba_in(f.path, "drop --help").out);
  CHECK(faba_in(f.path, "help dorp").exit == 2);

  write_file(f.path / "my scene.toml", "[[swarm]]\ncount = 5\n");
  const std::string out =
      faba_in(f.path, "run 'my scene.toml' --seed 3 --duration '1 s' --set 'swarm[0].count=7'").out;
  const auto at = out.find(" run 'my scene.toml' --seed 4 --duration '1 s' --set 'swarm[0].count=7'\n");
  REQUIRE(at != std::string::npos);
  CHECK(faba_in(f.path, out.substr(at + 1)).exit == 0);
}

TEST_CASE("every scene in scenes/ is accepted and runs") {
  const TestFolder f;
  for (const auto& entry : std::filesystem::directory_iterator(FABA_SCENES)) {
    if (entry.path().filename() == "gallery.toml") continue;  // the index of the gallery
    INFO(entry.path().string());
    const Called c =
        faba_in(f.path, "run '" + entry.path().string() + "' --seed 1 --duration '0.4 s' --json --out '" +
                            entry.path().stem().string() + "'");
    CHECK_MESSAGE(c.exit == 0, c.err);
    CHECK(c.json()["frames"].get<int>() > 0);
  }
}

TEST_CASE("drop: a rendered drop is detected; run --from-video keeps the swarm inside it") {
  const TestFolder f;
  const double cx = 130, cy = 80, r = 60;
  std::string pgm = "P5\n240 160\n255\n";
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 240; ++x) {
      const double d = std::hypot(x - cx, y - cy) - r;
      const int noise = (x * 7 + y * 13 + x * y) % 5;
      pgm += char(int(150 - 60 / (1 + std::exp(-d))) + noise);
    }
  write_file(f.path / "drop.pgm", pgm);
  const auto j = faba_in(f.path, "drop drop.pgm --json --overlay o.png").json();
  CHECK(j["center_px"][0].get<double>() == doctest::Approx(cx).epsilon(0.01));
  CHECK(j["center_px"][1].get<double>() == doctest::Approx(cy).epsilon(0.01));
  CHECK(j["radius_px"].get<double>() == doctest::Approx(r).epsilon(0.02));
  CHECK(j["image_size"] == nlohmann::json::array({240, 160}));
  CHECK(read_file(f.path / "o.png").starts_with("\x89PNG"));
  CHECK(faba_in(f.path, "drop drop.pgm --overlay o.png").exit == 2);  // not overwritten
  REQUIRE(faba_in(f.path, "drop drop.pgm --stages stages").exit == 0);
  for (const char* stage : {"1-grey.png", "2-edges.png", "3-lines.png", "4-circle.png"})
    CHECK(read_file(f.path / "stages" / stage).starts_with("\x89PNG"));
  CHECK(faba_in(f.path, "drop drop.pgm --stages stages").exit == 2);
  CHECK(faba_in(f.path, "drop drop.pgm --stages drop.pgm").exit == 2);

  const Called run = faba_in(f.path, "run '" FABA_SCENES
                                     "/drop.toml' --from-video drop.pgm --set swarm[0].count=60 "
                                     "--seed 1 --out run --json");
  REQUIRE_MESSAGE(run.exit == 0, run.err);
  CHECK(run.err.find("faba: note: drop: centre (") != std::string::npos);
  CHECK(run.err.find(" px, from drop.pgm") != std::string::npos);
  CHECK(faba_in(f.path, "track drop.pgm --drop").err.find("faba: note: drop: centre (") != std::string::npos);
  CHECK(run.json()["settling_time_s"].is_number());
  // The scale of the picture is not known.
  CHECK(run.json()["um_per_px"].is_null());
  CHECK(j["um_per_px"].is_null());
  CHECK(run.json()["um_per_px_source"].is_null());
  CHECK(run.json()["nominal_um_per_px"] == 0.9164);
  REQUIRE(run.json()["warnings"].size() == 1);
  CHECK(run.json()["warnings"][0]["aspect"] == "scale");
  CHECK(run.err.find("scale of the picture is not known") != std::string::npos);
  CHECK(faba_in(f.path, "track drop.pgm --json").json()["um_per_px"].is_null());
  const H5File tracks = H5File::open(f.path / "run/tracks.h5");
  const H5Table position = tracks.table("position_px");
  std::vector<float> row(position.row_size());
  for (std::uint64_t k = 0; k < position.rows(); ++k) {
    position.read<float>(k, row);
    for (std::size_t i = 0; i < row.size(); i += 2)
      REQUIRE(std::hypot(double(row[i]) - j["center_px"][0].get<double>(),
                         double(row[i + 1]) - j["center_px"][1].get<double>()) <=
              j["radius_px"].get<double>() + 1e-3);  // 32-bit positions
  }
}
