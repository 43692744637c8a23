#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "control/controller.h"
#include "core/table.h"
#include "rig/camera.h"
#include "rig/coil_driver.h"
#include "sim/motility.h"
#include "sim/start.h"
#include "vision/flow/flow.h"
#include "vision/render/ground.h"

namespace faba {

/// Readers of the files that a scenario names. The engine without the program reads only CSV tables: an empty
/// member gives Error(usage) for a scenario that names such a file.
struct Readers {
  std::function<Table(const std::filesystem::path&)> table;  ///< measured fields
  std::function<std::shared_ptr<const FieldLibrary>(const std::filesystem::path&)> library;
  std::function<std::string(const std::filesystem::path&)> library_task;  ///< task of a library
  std::function<VideoBackground(const std::filesystem::path&)> ground;  ///< illumination and noise of a video
};

/// All parts that a scenario can name, by kind, and the readers of its files.
struct Parts {
  ModelRegistry model{"model", "Law of motion of a swarm: [swarm.model]"};
  StartRegistry start{"start", "Initial positions of a swarm: [swarm.start]"};
  ArenaRegistry arena{"arena", "Region that contains the cells: [arena]"};
  FieldRegistry field{"field", "Magnetic field of the coils: [field]"};
  MotilityRegistry motility{"motility law", "Effect of air on the motility of the cells: motility = \"...\""};
  EstimatorRegistry estimator{"estimator", "Estimate of the state of the swarm: [estimator]"};
  ReferenceRegistry reference{"reference", "Setpoints for the swarm: [reference]"};
  ControllerRegistry controller{"controller", "Feedback law: [controller]"};
  FlowRegistry flow{"flow method", "Optical flow between two frames: [flow], --method"};
  CameraRegistry camera{"camera", "Camera of the bench: [rig.camera]"};
  CoilDriverRegistry driver{"coil driver", "Driver of the coil currents: [rig.driver]"};
  Readers readers;
};

/// The parts of the simulation engine: no devices, no optical flow, no files but CSV. Part of faba_engine.
Parts engine_parts();

/// All parts of the program, made at the first call.
const Parts& builtin_parts();
/// Its flow methods only: the help of every command needs them, and the others cost 2 ms.
const FlowRegistry& builtin_flow_methods();

/// Calls visit(key, registry) for every kind; key is the KIND of `faba parts KIND`.
template <class Visit>
void each_kind(const Parts& p, Visit&& visit) {
  visit("model", p.model);
  visit("start", p.start);
  visit("arena", p.arena);
  visit("field", p.field);
  visit("motility", p.motility);
  visit("estimator", p.estimator);
  visit("reference", p.reference);
  visit("controller", p.controller);
  visit("flow", p.flow);
  visit("camera", p.camera);
  visit("driver", p.driver);
}

}  // namespace faba
