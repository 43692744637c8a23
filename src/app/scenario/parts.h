#pragma once
#include "control/controller.h"
#include "rig/camera.h"
#include "rig/guard_setup.h"
#include "sim/motility.h"
#include "sim/start.h"
#include "vision/flow/flow.h"

namespace faba {

/// Every part that a scenario can name, by kind.
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
  CameraRegistry camera = builtin_cameras();
  CoilDriverRegistry driver = builtin_coil_drivers();
};

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
