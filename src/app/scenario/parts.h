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

/// What reads the files that a scenario names. The engine alone reads CSV tables and nothing else: members
/// that are empty make the scenario fail with Error(usage) where it names such a file.
struct Readers {
  std::function<Table(const std::filesystem::path&)> table;  ///< of numbers: measured fields
  std::function<std::shared_ptr<const FieldLibrary>(const std::filesystem::path&)> library;
  std::function<std::string(const std::filesystem::path&)> library_task;  ///< how a library was made
  std::function<VideoGround(const std::filesystem::path&)> ground;        ///< light and noise of a video
};

/// Every part that a scenario can name, by kind, and what reads the files that it can name.
struct Parts {
  ModelRegistry model{"agent model", "Law of motion of a swarm: [swarm.model]"};
  StartRegistry start{"start", "Where a swarm begins: [swarm.start]"};
  ArenaRegistry arena{"arena", "Where cells can be: [arena]"};
  FieldRegistry field{"field", "Magnetic field of the coils: [field]"};
  MotilityRegistry motility{"motility law", "What air does to the cells: motility = \"...\""};
  EstimatorRegistry estimator{"estimator", "What is believed of the swarm: [estimator]"};
  ReferenceRegistry reference{"reference", "Where the swarm should be: [reference]"};
  ControllerRegistry controller{"controller", "Feedback law: [controller]"};
  FlowRegistry flow{"flow method", "Optical flow between two frames: [flow], --method"};
  CameraRegistry camera{"camera", "Where the bench's pictures come from: [rig.camera]"};
  CoilDriverRegistry driver{"coil driver", "What puts current through the coils: [rig.driver]"};
  Readers readers;
};

/// The parts of the simulation engine: no devices, no optical flow, no files but CSV. Part of faba_engine.
Parts engine_parts();

/// All parts that come with the program.
Parts builtin_parts();

/// Calls visit(key, registry) for every kind; key is the word of `faba parts KIND`.
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
