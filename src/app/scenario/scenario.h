#pragma once
#include <limits>
#include <optional>

#include "app/loop/loop.h"
#include "app/scenario/event.h"
#include "app/scenario/parts.h"
#include "rig/rig_setup.h"
#include "sim/exclusion.h"
#include "vision/render/microscope_params.h"

namespace faba {

/// The table [record]: what a run keeps.
struct Record {
  bool tracks = true;
  int tracks_every = 1;
  bool compress = true;
  bool video = true;
  int video_every = 1;
  bool lossless = false;
  bool as_seen = false;
  bool flow = false;
  double checkpoint = 10;
  static Schema<Record> schema();
};

/// The table [camera].
struct CameraParams {
  enum class Sensor { positions, frames };
  double rate = 15;
  int delay_frames = 0;
  double jitter = 0;
  Sensor sensor = Sensor::positions;
  static Schema<CameraParams> schema();
};

/// The table [scale].
struct ScaleParams {
  double um_per_px = 0.9164;
  std::optional<double> iteration;
  double field_unit = 23e-6;
  static Schema<ScaleParams> schema();
};

/// The table [library]: a FieldLibrary that the run takes its grid from, and controllers of gradients their
/// currents.
struct LibraryParams {
  std::string file;
  std::string made;  ///< fingerprint of how the library was made
  static Schema<LibraryParams> schema();
};

/// The table [simulation].
struct SimulationParams {
  std::optional<double> step;
  double longest =
      std::numeric_limits<double>::infinity();  ///< s, of a step that is chosen; no key of a scenario
  static Schema<SimulationParams> schema();
};

/// One [[swarm]].
struct Swarm {
  enum class Polarity { north, south };
  struct Params {
    std::uint64_t count = 500;
    Polarity polarity = Polarity::south;
    double responding = 1;
    std::optional<double> heading;
  };
  static Schema<Params> schema();
  Params params;
  ModelRegistry::PartType model;
  StartRegistry::PartType start;
};

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

  std::uint64_t frames() const;  ///< of the whole run, at least 1
  double frame_period() const { return 1 / camera.rate; }
  /// Whether frames are rendered: for the loop or for the recording.
  bool renders() const {
    return camera.sensor == CameraParams::Sensor::frames || record.as_seen || record.flow;
  }
  Scale si_scale() const;
  /// Whether a feedback controller steers to a setpoint; false with a schedule of fields.
  bool steers() const { return controller.type != "manual"; }
  /// Polarity of most of the cells, which is what a controller steers: +1 or -1; south when both are as many.
  int polarity() const;
  /// Every key with its value; as TOML it reads back to the same scenario.
  Json resolved() const;
  /// Fingerprint of resolved() without title, seed and [record]: equal for runs that differ in seed or
  /// recording only.
  std::string hash() const;
};

}  // namespace faba
