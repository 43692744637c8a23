#pragma once
#include <optional>

#include "app/loop/limits.h"
#include "app/scenario/event.h"
#include "app/scenario/parts.h"
#include "app/scenario/sections/camera.h"
#include "app/scenario/sections/field.h"
#include "app/scenario/sections/library.h"
#include "app/scenario/sections/record.h"
#include "app/scenario/sections/rig.h"
#include "app/scenario/sections/scale.h"
#include "app/scenario/sections/simulation.h"
#include "app/scenario/sections/swarm.h"
#include "sim/exclusion.h"
#include "vision/render/microscope_params.h"

namespace faba {

struct Scenario;
/// Reads [[event]] (read_event.h), each for the scenario after the previous events.
void read_events(const Node& root, const Parts& parts, Scenario& s);

/// A scenario, read and checked: everything that defines a run, except the seed if it is not given.
struct Scenario {
  struct Params {
    std::string title;
    std::optional<std::uint64_t> seed;
    double duration = 20;
    double exposure = 0;
  };
  static Schema<Params> schema();

  Params params;
  ScaleParams scale;
  CameraParams camera;
  MicroscopeParams microscope;
  SimulationParams simulation;
  Limits::Params limits;
  Exclusion::Params exclusion;
  Record record;
  std::optional<LibraryParams> library;
  ArenaRegistry::PartType arena;
  FieldRegistry::PartType field;
  MotilityRegistry::PartType motility;
  EstimatorRegistry::PartType estimator;
  ReferenceRegistry::PartType reference;
  ControllerRegistry::PartType controller;
  FlowRegistry::PartType flow;  ///< method of record.flow
  std::vector<Swarm> swarms;
  std::vector<Event> events;    ///< in order of time
  std::optional<RigSetup> rig;  ///< bench for the scenario
  Readers readers;              ///< readers of the files that it names

  /// The sections of a scenario file, in the order of a resolved scenario. To add one: add its file in
  /// sections/, its member above, and its line here.
  template <class Sections>
  static void describe(Sections& s) {
    using S = Scenario;
    s.table("scale", &S::scale, ScaleParams::schema).also_key("file", calibration_file_json_schema()).hashed =
        [](const S& from) { return hashed_scale(from.scale); };
    s.table("camera", &S::camera, CameraParams::schema);
    s.table("microscope", &S::microscope, MicroscopeParams::schema)
        .when(&S::renders)
        .hashed_when(&S::sees_pictures);
    s.table("simulation", &S::simulation, SimulationParams::schema);
    s.part("arena", &S::arena, &Parts::arena, "box");
    s.table("exclusion", &S::exclusion, Exclusion::schema);
    s.part("field", &S::field, &Parts::field, "uniform").json_schema = field_json_schema;
    s.part("motility", &S::motility, &Parts::motility, "none");
    s.composed(
         "swarm", [](const Node& n, const Parts& p, S& to) { to.swarms = read_swarms(n, p); },
         [](const S& from) { return swarms_json(from.swarms); }, swarms_json_schema)
        .fill_in = [](const Node& n, const Parts&, S&) {
      n.fail("[[swarm]] is missing; at least one is required");
    };
    s.part("estimator", &S::estimator, &Parts::estimator, &S::default_estimator);
    s.part("reference", &S::reference, &Parts::reference, &S::default_reference);
    s.part("controller", &S::controller, &Parts::controller, "fuzzy");
    s.table("limits", &S::limits, Limits::schema);
    s.part("flow", &S::flow, &Parts::flow, {{"type", "horn_schunck"}, {"preset", "published"}})
        .when(&S::records_flow)
        .not_hashed();
    s.table("record", &S::record, Record::schema).not_hashed();
    s.composed(
         "library", [](const Node& n, const Parts& p, S& to) { to.library = read_library(n, p.readers); },
         [](const S& from) { return from.library ? LibraryParams::schema().to_json(*from.library) : Json(); },
         [](const Parts&) { return LibraryParams::schema().json_schema(); })
        .hashed = [](const S& from) { return from.library ? from.library->hashed() : Json(); };
    s.composed(
         "rig",
         [](const Node& n, const Parts& p, S& to) {
           to.rig = RigSetup::read(n.child("rig"), to.field.make({})->coils(), p.camera, p.driver);
         },
         [](const S& from) { return from.rig ? from.rig->resolved() : Json(); }, rig_json_schema)
        .not_hashed()
        .readable = [](const Parts& p) { return !p.camera.empty() && !p.driver.empty(); };
    s.composed(
        "event", read_events, [](const S& from) { return events_json(from.events); }, events_json_schema);
  }

  std::uint64_t frames() const;  ///< number of frames of the run, at least 1
  /// Frames from record.from to record.to.
  FrameRange recorded_frames() const;
  double frame_period() const { return 1 / camera.rate; }
  /// Whether the control loop gets pictures, not positions.
  bool sees_pictures() const { return camera.sensor == CameraParams::Sensor::frames; }
  bool records_flow() const { return record.flow; }
  /// Whether frames are rendered, for the control loop or for the recording.
  bool renders() const { return sees_pictures() || record.as_seen || record.flow; }
  Scale si_scale() const;
  /// Whether a feedback controller steers to a setpoint; false for open-loop control.
  bool steers() const { return !controller.has(Trait::open_loop); }
  /// The default estimator: "mean" of all positions if the camera gives positions, otherwise "image"; "none"
  /// with pictures and without feedback.
  Json default_estimator() const;
  /// The default reference.
  Json default_reference() const;
  /// Polarity of the majority of the cells, which the controller steers: +1 (north) or -1 (south); -1 for
  /// equal numbers.
  int polarity() const;
  /// Illumination and noise of the video microscope.background, which is read; null if it is not set. Throws
  /// Error(usage) without a reader, and the errors of the reader.
  std::shared_ptr<const VideoBackground> ground() const;
  /// The library of [library]; null if it is not set. Throws as ground().
  std::shared_ptr<const FieldLibrary> field_library() const;
  /// All keys with their values; as TOML it gives the same scenario when read.
  Json resolved() const;
  /// Hash of everything that affects the result of a run: of resolved() without title, seed and the settings
  /// of recording and execution.
  std::string hash() const;
};

}  // namespace faba
