#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/verbs.h"

namespace faba::cli {
namespace {

void add_scene(CLI::App* v, RunVerb& o) {
  v->add_option("scene", o.scene, "Scenario file (TOML) with a [rig]")->required();
  v->add_option("--set", o.set, "Change one value: PATH=VALUE")->take_all()->allow_extra_args(false);
  v->add_option("--seed", o.seed, "Seed of all randomness of a simulated bench");
  v->add_option("--threads", o.threads, "Threads; all of the machine's when absent")
      ->check(CLI::Range(1, 1024));
}

}  // namespace

void add_rig_verbs(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<RigVerb>();
  CLI::App* rig = app.add_subcommand("rig", "The bench: a camera and coils, real or simulated");
  rig->require_subcommand(1);
  CLI::App* v = verb(*rig, line, "list", "Cameras and coil drivers that this machine has", "  faba rig list");
  v->callback([&line] { line.code = rig_list(line.common); });
  v = verb(*rig, line, "check", "Look through the camera and ask the coils' driver, without any current",
           "  faba rig check scenes/bench.toml");
  add_scene(v, o->run);
  v->callback([o, &line] { line.code = rig_check(*o, line.common); });

  v = verb(*rig, line, "capture", "Record the camera alone: a video or numbered pictures, all frames or some",
           "  faba rig capture scenes/bench.toml --for \"10 s\" --out look.avi\n"
           "  faba rig capture scenes/bench.toml --frames 600 --one-of 10 --format pgm --out pictures\n"
           "  faba rig capture scenes/bench.toml --every \"500 ms\" --out lapse.mp4      until Ctrl-C");
  add_scene(v, o->run);
  v->add_option("-o,--out", o->run.out, "Video (.avi without loss, .mp4), or folder of pictures")
      ->required()
      ->check(not_empty);
  v->add_option("--format", o->format, "Of numbered pictures in a folder")
      ->check(CLI::IsMember({"png", "pgm", "ppm", "tiff"}));
  v->add_option("--frames", o->frames, "End after as many frames of the camera, or --for if that is sooner")
      ->check(CLI::Range(std::uint64_t(1), std::uint64_t(1) << 40));
  v->add_option("--for", o->time, "End after as long, such as \"10 s\"; until Ctrl-C without an end");
  CLI::Option* one_of =
      v->add_option("--one-of", o->one_of, "Keep one of as many frames")->check(CLI::Range(1, 1000000));
  v->add_option("--every", o->every, "Keep one frame every so long, such as \"500 ms\"")->excludes(one_of);
  v->add_flag("--buffered", o->buffered,
              "Keep pictures in memory and write them afterwards: for disks that are too slow");
  v->add_flag("--force", o->run.force, "Replace a video");
  v->callback([o, &line] { line.code = rig_capture(*o, line.common); });

  v = verb(*rig, line, "jog",
           "Set currents by hand, from the keyboard: step by step, largest, smallest, none",
           "  faba rig jog scenes/bench.toml --step \"20 mA\"");
  add_scene(v, o->run);
  v->add_option("--step", o->step, "How far a key goes")->check(not_empty);
  v->callback([o, &line] { line.code = rig_jog(*o, line.common); });

  v = verb(*rig, line, "run", "Run a scenario on the bench: the closed loop, recorded",
           "  faba rig run scenes/bench.toml --arm\n"
           "  faba rig run scenes/bench.toml --arm --duration \"5 s\" --out runs/a");
  add_scene(v, o->run);
  v->add_flag("--arm", o->arm, "Let current flow: somebody who sees the coils says that they may be on");
  v->add_option("-o,--out", o->run.out, "Run directory; runs/SCENE-bench when absent")->check(not_empty);
  v->add_option("--duration", o->run.duration, "Time on the clock, such as \"10 s\"");
  v->add_flag("--force", o->run.force, "Replace an earlier run in the directory");
  v->callback([o, &line] { line.code = rig_run(*o, line.common); });

  v = verb(
      *rig, line, "step-response",
      "Gather the swarm at one side, reverse the field and record; again and again on a schedule",
      "  faba rig step-response scenes/exposure.toml --arm\n"
      "  faba rig step-response scenes/exposure.toml --arm --exposure \"90 s\" --repeat 8 --every \"80 s\" "
      "--out runs/ageing\n"
      "  faba activity runs/ageing/study.toml");
  add_scene(v, o->run);
  v->add_flag("--arm", o->arm, "Let current flow: somebody who sees the coils says that they may be on");
  v->add_option("-o,--out", o->run.out,
                "Directory of the study, which may hold earlier ones; runs/SCENE-response when absent")
      ->check(not_empty);
  v->add_option("--exposure", o->exposure,
                "Time that the sample has been in air when this begins, such as \"90 s\"");
  v->add_option("--repeat", o->repeat, "How many are recorded");
  v->add_option("--every", o->every, "From the beginning of one to that of the next, such as \"80 s\"");
  v->add_option("--experiment", o->experiment, "Name of the drop; a number when absent")->check(not_empty);
  v->callback([o, &line] { line.code = rig_step_response(*o, line.common); });

  v = verb(*rig, line, "replay",
           "Do the decisions of a recorded run again, and compare its commands bit for bit",
           "  faba rig replay runs/bench-bench");
  v->add_option("dir", o->run.scene, "Run directory, with video.avi")->required();
  v->callback([o, &line] { line.code = rig_replay(*o, line.common); });

  v = verb(*rig, line, "simulate", "A simulated bench for other processes: microscope and coils in real time",
           "  faba rig simulate scenes/bench.toml --at /tmp/bench --log coils.csv");
  add_scene(v, o->run);
  v->add_option("--at", o->at, "Name of the socket to be made")->required()->check(not_empty);
  v->add_option("--log", o->log, "CSV of times, voltages and currents")->check(not_empty);
  v->add_flag("--force", o->run.force, "Replace an earlier log");
  v->add_flag("--once", o->once, "End when those that came have gone");
  v->callback([o, &line] { line.code = rig_simulate(*o, line.common); });
}

}  // namespace faba::cli
