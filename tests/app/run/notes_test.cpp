#include "app/run/notes.h"

#include <doctest/doctest.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tests/swarm.h"

using namespace faba;

namespace {

constexpr const char* kField = "[controller]\ntype = 'manual'\nfield = ['100 uT', '0 T']\n";

std::vector<std::string> notes_of(const std::string& toml) {
  const TestSwarm swarm(toml);
  return scenario_notes(swarm.scenario, swarm.simulation, ".");
}

/// A scenario with one swarm of the given content, and other tables after it.
std::string scene(const std::string& swarm, const std::string& tables, const std::string& top = "") {
  return top + "[[swarm]]\ncount = 20\n" + swarm + "\n" + tables;
}

/// Whether there is exactly one note, and it has all these parts.
void check_note(const std::string& toml, const std::vector<std::string>& parts) {
  const std::vector<std::string> notes = notes_of(toml);
  INFO(toml, "\n", fmt::format("{}", fmt::join(notes, "\n")));
  CHECK(notes.size() == 1);
  for (const std::string& part : parts)
    CHECK(std::any_of(notes.begin(), notes.end(),
                      [&](const std::string& note) { return note.find(part) != std::string::npos; }));
}

}  // namespace

TEST_CASE("cells that do not swim or do not turn are noted by their model") {
  check_note(scene("model = { type = 'dipole', motile = 0 }", kField), {"swarm[0].model: motile is 0"});
  check_note(scene("model = { type = 'dipole', speed = 0, speed_sd = 0 }", kField),
             {"swarm[0].model: speed is 0: the cells do not swim"});
  check_note(scene("model = { type = 'dipole', speed = 0 }", kField),
             {"speed_sd is 45 um/s", "speed_sd = 0"});
  check_note(scene("model = { type = 'dipole', moment = 0 }", kField), {"swarm[0].model: moment is 0"});
  check_note(scene("model = { type = 'adapted', max_speed = 0.4 }", kField),
             {"max_speed is 0.4, rounded to 0"});
  CHECK(notes_of(scene("model = { type = 'adapted', max_speed = 0.4, continuous_speed = true }", kField))
            .empty());
  CHECK(notes_of(scene("model = 'basic'", kField)).empty());
  const std::string event = "[[event]]\nframe = 3\nmodel = { type = 'dipole', motile = 0 }\n";
  check_note(scene("model = 'dipole'", kField + event), {"event[0].model: motile is 0"});
}

TEST_CASE("a command that is always zero is noted") {
  check_note(scene("", "[controller]\ntype = 'manual'\n"), {"controller: every command is zero"});
  check_note(scene("", "[controller]\ntype = 'manual'\ncurrent = [0, 0]\n"), {"every command is zero"});
  check_note(scene("", "[controller]\ntype = 'fuzzy'\nmax_output = 0\n"),
             {"every command is zero", "increase controller.max_output"});
  check_note(scene("", "[controller]\ntype = 'proportional'\nmax_output = 0\n"), {"every command is zero"});
  check_note(scene("", "[controller]\ntype = 'proportional'\ngain = 0\n"),
             {"every command is zero", "increase controller.gain or controller.max_output"});
  // The field before the first segment, of a later segment or of a later controller is not zero.
  CHECK(notes_of(
            scene("", "[controller]\ntype = 'manual'\n[[controller.segment]]\nat = 1\nfield = ['1 mT', 0]\n"))
            .empty());
  CHECK(notes_of(scene("", std::string("[controller]\ntype = 'manual'\n[[event]]\nframe = 9\n") +
                               "controller = { type = 'manual', field = ['1 mT', 0] }\n"))
            .empty());
  // A field that is replaced at time 0 has no effect.
  check_note(scene("", std::string(kField) + "[[controller.segment]]\nat = 0\n"), {"every command is zero"});
}

TEST_CASE("the bound of a weak field is 1 % of alignment") {
  // kT / m = 4.116e-21 J / 1e-15 A m^2 = 4.116 uT; the alignment is at most m B / (2 kT).
  const std::string dipole = "model = { type = 'dipole', moment = '1e-15 A m^2', temperature = 298.15 }";
  const auto manual = [](const char* field) {
    return fmt::format("[controller]\ntype = 'manual'\nfield = ['{}', 0]\n", field);
  };
  check_note(scene(dipole, manual("1 nT")),
             {"largest field is 0.001 uT", "swarm[0] need at least 0.0823 uT", "rotational"});
  check_note(scene(dipole, manual("82.2 nT")), {"at least 0.0823 uT"});
  CHECK(notes_of(scene(dipole, manual("82.4 nT"))).empty());
  // Without rotational diffusion, the run of 20 s must be long enough for the turn: w_B t / 2 = 1 %.
  const std::string drag = "model = { type = 'dipole', rotational_diffusion = 0 }";
  check_note(scene(drag, manual("1 pT")),
             {"stays below 1 % until the end of the run; increase controller.field or controller.current"});
  CHECK(notes_of(scene(drag, manual("20 nT"))).empty());
  // 300 iterations of one field unit each: 23 uT / 300 moves the cells by one pixel.
  check_note(scene("model = 'basic'", manual("76 nT")), {"need at least 0.0767 uT", "one pixel"});
  CHECK(notes_of(scene("model = 'basic'", manual("77 nT"))).empty());
  check_note(scene("model = 'adapted'", manual("0.2 uT")), {"need at least 0.23 uT", "0.01 rad"});
  CHECK(notes_of(scene("model = { type = 'adapted', earth = 0 }", manual("1 nT"))).empty());
  // Cells that do not respond to any field need no field.
  check_note(scene(dipole + "\nresponding = 0", manual("1 nT")), {"responding is 0"});
}

TEST_CASE("coils and outputs that are too weak to move the cells are noted") {
  check_note(scene("", "[limits]\nmax_current = '1 uA'\n"),
             {"field: the largest field is", "limits.max_current"});
  check_note(
      scene("", std::string("[field]\ntype = 'rig'\n[[field.coil]]\ntype = 'loop'\nradius = '1 cm'\n") +
                    "axis = [1, 0, 0]\nmax_current = '1 uA'\n" + kField),
      {"field: the largest field is", "max_current of the coils"});
  check_note(scene("", "[controller]\ntype = 'fuzzy'\nmax_output = 1e-4\n"),
             {"controller: the largest field is 0.0023 uT", "increase controller.max_output"});
  check_note(scene("", "[controller]\ntype = 'proportional'\nmax_output = 1e-4\n"),
             {"largest field is 0.0023 uT"});
  CHECK(notes_of(scene("", "")).empty());
}

TEST_CASE("coils that cannot move the cells are noted") {
  check_note(
      scene("", std::string("[field]\ntype = 'rig'\n[[field.coil]]\ntype = 'loop'\nradius = '1 cm'\n") +
                    "axis = [0, 0, 1]\n"),
      {"field: these coils have no field in the plane of the sample"});
  check_note(scene("", "[controller]\ntype = 'gradient'\n"), {"\"uniform\" have no gradient"});
}

TEST_CASE("settings without effect are noted") {
  check_note(scene("", std::string(kField) + "[[event]]\nframe = 30\nmodel = 'dipole'\n", "duration = 2\n"),
             {"event[0].frame: 30 is after the last frame of the run (29)"});
  CHECK(
      notes_of(scene("", std::string(kField) + "[[event]]\nframe = 29\nmodel = 'dipole'\n", "duration = 2\n"))
          .empty());
  check_note(scene("", std::string(kField) + "[camera]\njitter = '1 s'\n"),
             {"camera.jitter is 1 s", "0.4 frame"});
  CHECK(notes_of(scene("", std::string(kField) + "[camera]\njitter = '10 ms'\n")).empty());
  check_note(scene("", std::string(kField) + "[record]\nvideo = false\nas_seen = true\n"),
             {"record.as_seen (--as-seen) has no effect"});
  CHECK(
      notes_of(scene("", std::string(kField) + "[record]\nvideo = false\nlossless = true\nas_seen = true\n"))
          .empty());
  check_note(scene("model = { type = 'dipole', temperature = '20 K' }", kField),
             {"swarm[0].model: temperature is 20 K", "293.15 K"});
}

TEST_CASE("a camera delay without effect on the run is noted") {
  const auto camera = [](int frames, const char* more) {
    return fmt::format("[camera]\ndelay_frames = {}\n[limits]\nmax_frame_age = 100\n{}", frames, more);
  };
  check_note(scene("", camera(30, ""), "duration = 2\n"),
             {"camera.delay_frames is 30, but the run has 30 frames"});
  CHECK(notes_of(scene("", camera(29, ""), "duration = 2\n")).empty());
  CHECK(notes_of(scene("", camera(30, kField), "duration = 2\n")).empty());  // open loop
  check_note(scene("", "[camera]\ndelay_frames = 16\n"),
             {"16: every picture is 1.07 s old", "max_frame_age = 1 s"});
  CHECK(notes_of(scene("", "[camera]\ndelay_frames = 15\n")).empty());
}

TEST_CASE("a drop or a swarm out of view is noted") {
  const auto drop = [](const char* centre) {
    return fmt::format("[arena]\ntype = 'drop'\nradius_px = 100\ncentre_px = [{}]\n{}", centre, kField);
  };
  check_note(scene("", drop("-101, 100")), {"arena: its centre is at (-101, 100) px", "640 x 480 px"});
  check_note(scene("", drop("-75, -75")), {"arena: its centre is at"});  // the corner is out of reach
  CHECK(notes_of(scene("start = 'visible'", drop("-50, 100"))).empty());
  check_note(scene("start = { type = 'disc', centre_px = [-60, 100], radius_px = 10 }", drop("-50, 100")),
             {"swarm[0].start: no cell is in the camera view at the start"});
}

TEST_CASE("obstacles around the start and across the way are noted") {
  const auto with = [](const std::string& corners) {
    return notes_of(
        scene("model = { type = 'dipole', preset = 'IT-1' }\n"
              "start = { type = 'disc', centre_px = [180, 240], radius_px = 12 }",
              "[arena]\ntype = 'drop'\nradius_px = 220\n[controller]\ntype = 'mpc'\n"
              "[[controller.obstacle]]\ncorners_px = " +
                  corners + "\n[reference]\ntype = 'hold'\nsetpoint_px = [460, 240]\n"));
  };
  CHECK(with("[[300, 190], [340, 190], [340, 270], [300, 270]]").empty());
  const auto around = with("[[140, 200], [220, 200], [220, 280], [140, 280]]");
  REQUIRE(around.size() == 1);
  CHECK(around[0].find("the mean of the swarm starts in an obstacle") != std::string::npos);
  const auto across = with("[[300, 0], [340, 0], [340, 480], [300, 480]]");
  REQUIRE(across.size() == 1);
  CHECK(across[0].find("from the start of the swarm to its first setpoint leads outside of the drop") !=
        std::string::npos);
}

TEST_CASE("the scenarios of scenes/ have the notes that they are meant to have") {
  std::vector<std::string> with_notes;
  for (const auto& file : std::filesystem::directory_iterator(FABA_SCENES)) {
    if (file.path().filename() == "gallery.toml") continue;  // the index of the gallery
    Document d = read_toml(file.path());
    for (Json& swarm : d.root["swarm"]) swarm["count"] = std::min(swarm.value("count", 500), 500);
    const Scenario s = read_scenario(d, builtin_parts());
    Pool pool(1);
    const Simulation simulation(s, 1, pool);
    if (!scenario_notes(s, simulation, ".").empty()) with_notes.push_back(file.path().stem().string());
  }
  std::sort(with_notes.begin(), with_notes.end());
  // One cell that circles widely, and the figures of two coils, whose zeros of the field are reported.
  CHECK(with_notes == std::vector<std::string>{"one-cell-msr1", "thesis-coils-c", "thesis-coils-d"});
}
