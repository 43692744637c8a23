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
/// Reads [[event]] (read_event.h): each against the scenario as it stands then.
void read_events(const Node& root, const Parts& parts, Scenario& s);

/// A scenario, read and checked: everything about a run except its seed when none is given.
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
  FlowRegistry::PartType flow;  ///< that record.flow is made with
  std::vector<Swarm> swarms;
  std::vector<Event> events;    ///< in order of time
  std::optional<RigSetup> rig;  ///< the bench that it can be run on
  Readers readers;              ///< of the files that it names

  /// The sections of a scenario file, in the order in which a resolved scenario has them. To add one: its
  /// file in sections/, its member above, its line here.
  template <class Sections>
  static void describe(Sections& s) {
    using S = Scenario;
    s.table("scale", &S::scale, ScaleParams::schema).also_key("file", calibration_file_json_schema());
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
        .fill_in = [](const Node& n, const Parts&, S&) { n.fail("needs at least one [[swarm]]"); };
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

  std::uint64_t frames() const;  ///< of the whole run, at least 1
  double frame_period() const { return 1 / camera.rate; }
  /// Whether the loop gets pictures, not positions.
  bool sees_pictures() const { return camera.sensor == CameraParams::Sensor::frames; }
  bool records_flow() const { return record.flow; }
  /// Whether frames are rendered: for the loop or for the recording.
  bool renders() const { return sees_pictures() || record.as_seen || record.flow; }
  Scale si_scale() const;
  /// Whether a feedback controller steers to a setpoint; false with a schedule of fields.
  bool steers() const { return !controller.has(Trait::open_loop); }
  /// The estimator of a scenario that names none: all positions where the camera gives them, else the
  /// picture; none without feedback, since nobody needs to know where the cells are.
  Json default_estimator() const;
  /// The reference of a scenario that names none.
  Json default_reference() const;
  /// Polarity of most of the cells, which is what a controller steers: +1 or -1; south when both are as many.
  int polarity() const;
  /// Light and noise of the video microscope.background; null when none is named. Reads the video. Throws
  /// Error(usage) where no reader is at hand, and what the reader throws.
  std::shared_ptr<const VideoGround> ground() const;
  /// The library of [library]; null when none is named. Throws as ground().
  std::shared_ptr<const FieldLibrary> field_library() const;
  /// Every key with its value; as TOML it reads back to the same scenario.
  Json resolved() const;
  /// Hash of what happens in a run: of resolved() without title, seed and what only says how the run
  /// is recorded or carried out.
  std::string hash() const;
};

}  // namespace faba
