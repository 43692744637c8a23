#include "study/experiment/experiment.h"

#include <doctest/doctest.h>

#include <cmath>

#include "core/error.h"
#include "core/file.h"
#include "tests/temporary_folder.h"

using namespace faba;

namespace {

Experiment experiment_of(const std::string& text) {
  return read_experiment(parse_toml(text, kExperimentFile));
}

constexpr const char* kOne = R"(
title = "Ageing drops"
um_per_px = 0.64
um_per_px_source = "calibration"
[[drop]]
name = "A"
polarity = "south"
[[drop]]
name = "B"
[[video]]
file = "videos/a.mp4"
drop = "A"
exposure = "2 min"
reversal = "4 s"
field_direction = "90 deg"
[[video]]
file = "/data/b.mp4"
drop = "B"
field_direction = "90 deg"
um_per_px = 1.2
)";

}  // namespace

TEST_CASE("an experiment file is read with units") {
  const Experiment e = experiment_of(kOne);
  CHECK(e.title == "Ageing drops");
  REQUIRE(e.videos.size() == 2);
  CHECK(e.videos[0].exposure_s == 120);
  CHECK(e.videos[0].reversal_s == 4);
  CHECK(scale_of(e, e.videos[0])->um_per_px == 0.64);
  CHECK(scale_of(e, e.videos[0])->source == "calibration");
  CHECK(scale_of(e, e.videos[1])->um_per_px == 1.2);
  CHECK(scale_of(e, e.videos[1])->source == "typed");
  CHECK(!scale_of({}, {}));
  CHECK(video_path("/lab/experiments/x/experiment.toml", e.videos[0]) == "/lab/experiments/x/videos/a.mp4");
  CHECK(video_path("/lab/experiments/x/experiment.toml", e.videos[1]) == "/data/b.mp4");
}

TEST_CASE("a measured scale has its standard error and source, of the experiment and of a video") {
  const Experiment e = experiment_of(R"(
um_per_px = 0.64
um_per_px_se = 0.01
um_per_px_source = "calibration"
[[video]]
file = "a.mp4"
[[video]]
file = "b.mp4"
um_per_px = 1.2
um_per_px_se = 0.05
um_per_px_source = "ruler"
[[video]]
file = "c.mp4"
um_per_px = 1.3
)");
  CHECK(scale_of(e, e.videos[0])->standard_error == 0.01);
  CHECK(scale_of(e, e.videos[1])->standard_error == 0.05);
  CHECK(scale_of(e, e.videos[1])->source == "ruler");
  CHECK(!scale_of(e, e.videos[2])->standard_error);  // not that of another scale
  CHECK(scale_of(e, e.videos[2])->source == "typed");
}

TEST_CASE("field segments of a video, with angles counter-clockwise") {
  const Experiment e = experiment_of(R"(
[[video]]
file = "a.mp4"
[[video.segment]]
from = "5.6 s"
to = "8.5 s"
direction = "90 deg"
[[video.segment]]
from = "8.5 s"
to = "18.2 s"
)");
  REQUIRE(e.videos[0].segments.size() == 2);
  CHECK(e.videos[0].segments[0].from_s == 5.6);
  CHECK(*e.videos[0].segments[0].direction == doctest::Approx(M_PI / 2));
  CHECK(!e.videos[0].segments[1].direction);
  CHECK(experiment_schema()["properties"]["video"]["items"]["properties"]["segment"]["items"]["properties"]
            .contains("direction"));
}

TEST_CASE("the swimming direction follows from the field and the polarity") {
  Experiment e = experiment_of(kOne);
  // Up in the picture is 270 degrees with y down; south-seeking cells swim against the field.
  CHECK(*swimming_direction_deg(e, e.videos[0]) == doctest::Approx(90));
  e.drops[0].polarity = CellPolarity::north;
  CHECK(*swimming_direction_deg(e, e.videos[0]) == doctest::Approx(270));
  e.videos[0].field_direction = 0;
  CHECK(*swimming_direction_deg(e, e.videos[0]) == doctest::Approx(0));
  CHECK(!swimming_direction_deg(e, e.videos[1]));  // unknown polarity
  e.videos[0].field_direction.reset();
  CHECK(!swimming_direction_deg(e, e.videos[0]));
}

TEST_CASE("errors of an experiment file name the value and the permitted values") {
  const auto fails = [](const std::string& text, const char* what) {
    INFO(text);
    CHECK_THROWS_WITH_AS(experiment_of(text), doctest::Contains(what), const Error&);
  };
  fails("[[drop]]\nname = \"A\"\npolarity = \"up\"", "north");
  fails("[[drop]]\nname = \"A\"\n[[drop]]\nname = \"A\"", "used by another drop");
  fails("[[video]]\nfile = \"a.mp4\"\ndrop = \"C\"", "is not the name of a [[drop]]");
  fails("[[video]]\nfile = \"a.mp4\"\n[[video]]\nfile = \"a.mp4\"", "used by another [[video]]");
  fails("[[video]]\nexposure = \"1 s\"", "specify a video");
  fails("[[video]]\nfile = \"a.mp4\"\nfrom = \"4 s\"\nto = \"3 s\"", "is not later than");
  fails("[[video]]\nfile = \"a.mp4\"\nexposure = \"-4 s\"", "exposure");
  fails("um_per_px_source = \"guess\"", "must be one of calibration, ruler, typed, metadata");
  fails("um_per_px_se = 0.1", "um_per_px, which is missing");
  fails("um_per_px = 0.5\num_per_px_se = 0.5", "must be less than um_per_px = 0.5");
  fails("[[video]]\nfile = \"a.mp4\"\num_per_px_se = 0.1", "um_per_px, which is missing");
  const std::string video = "[[video]]\nfile = \"a.mp4\"\n";
  fails(video + "segment = [{ from = \"2 s\", to = \"2 s\" }]", "to = 2 s is not later than from = 2 s");
  fails(video + "segment = [{ from = \"1 s\", to = \"3 s\" }, { from = \"2 s\", to = \"4 s\" }]",
        "item 1 starts at 2 s, before item 0 ends (3 s)");
  fails(video + "segment = 3", "segment");
  fails("drop = 3", "[[drop]]");
}

TEST_CASE("a folder with an experiment file is an experiment") {
  const test::TemporaryFolder folder("experiment");
  CHECK(!experiment_file(folder.path()));
  write_file(folder.path() / kExperimentFile, kOne);
  CHECK(experiment_file(folder.path()) == folder.path() / kExperimentFile);
  CHECK(experiment_file("x/experiment.toml") == std::filesystem::path("x/experiment.toml"));
  CHECK(!experiment_file("x/study.toml"));
}
