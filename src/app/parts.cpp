// All parts that a scenario can name. This file is compiled three times: for the engine, without devices,
// picture files and optical flow; for the coil guard, with the coil drivers only; and for the program, with
// all parts (CMakeLists.txt).
#include "app/scenario/parts.h"
#ifdef FABA_PARTS_OF_PROGRAM
#include "app/files/field_points.h"
#include "app/files/library_file.h"
#include "vision/cells/video_ground.h"
#endif

namespace faba {

// To add a part: write its file, add its line here. Coils must be listed before the coil system that contains
// them.
#define FABA_ENGINE_PARTS(X)   \
  X(model, basic)              \
  X(model, adapted)            \
  X(model, dipole)             \
  X(start, start_uniform)      \
  X(start, start_visible)      \
  X(start, start_edge)         \
  X(start, start_disc)         \
  X(start, start_places)       \
  X(arena, box)                \
  X(arena, drop)               \
  X(field, uniform)            \
  X(field, loop)               \
  X(field, solenoid)           \
  X(field, thick_coil)         \
  X(field, dipole_coil)        \
  X(field, helmholtz)          \
  X(field, map)                \
  X(field, rig)                \
  X(motility, motility_none)   \
  X(motility, motility_thesis) \
  X(estimator, mean)           \
  X(estimator, visible)        \
  X(estimator, estimator_none) \
  X(estimator, image)          \
  X(estimator, groups)         \
  X(estimator, kalman)         \
  X(reference, none)           \
  X(reference, hold)           \
  X(reference, route)          \
  X(reference, path)           \
  X(controller, manual)        \
  X(controller, fuzzy)         \
  X(controller, proportional)  \
  X(controller, lqr)           \
  X(controller, mpc)           \
  X(controller, gradient)      \
  X(controller, gradient_feedback)

#define FABA_FLOW_PARTS(X) \
  X(flow, horn_schunck)    \
  X(flow, dis)             \
  X(flow, farneback)

#define FABA_PROGRAM_PARTS(X) \
  X(camera, simulated_camera) \
  X(camera, playback)         \
  X(camera, opencv)

#define FABA_COIL_DRIVERS(X) \
  X(driver, no_coils)        \
  X(driver, simulated_coils) \
  X(driver, nidaqmx)         \
  X(driver, serial)

#define FABA_DECLARE(kind, name) void add_##name(decltype(Parts::kind)&);
FABA_ENGINE_PARTS(FABA_DECLARE)
FABA_FLOW_PARTS(FABA_DECLARE)
FABA_PROGRAM_PARTS(FABA_DECLARE)
FABA_COIL_DRIVERS(FABA_DECLARE)
#undef FABA_DECLARE

#define FABA_ADD(kind, name) add_##name(p.kind);

#if defined FABA_PARTS_OF_PROGRAM

namespace {
constexpr const char* kPythonPart =
    "this part is a class in Python, which the program does not have; use the Python package, for example "
    "faba.resume(DIRECTORY) or faba.replay(DIRECTORY)";

Parts all_parts() {
  Parts p;
  FABA_ENGINE_PARTS(FABA_ADD)
  p.flow = builtin_flow_methods();
  FABA_PROGRAM_PARTS(FABA_ADD)
  FABA_COIL_DRIVERS(FABA_ADD)
  p.estimator.elsewhere("python", kPythonPart);
  p.reference.elsewhere("python", kPythonPart);
  p.controller.elsewhere("python", kPythonPart);
  p.readers.table = [](const std::filesystem::path& file) { return read_field_points(file); };
  p.readers.library = open_library;
  p.readers.library_task = library_task;
  p.readers.ground = [](const std::filesystem::path& video) { return read_video_background(video); };
  return p;
}

FlowRegistry flow_methods() {
  Parts p;
  FABA_FLOW_PARTS(FABA_ADD)
  return p.flow;
}
}  // namespace

const Parts& builtin_parts() {
  static const Parts parts = all_parts();
  return parts;
}

const FlowRegistry& builtin_flow_methods() {
  static const FlowRegistry methods = flow_methods();
  return methods;
}

#elif defined FABA_PARTS_OF_GUARD

CoilDriverRegistry builtin_coil_drivers() {
  Parts p;
  FABA_COIL_DRIVERS(FABA_ADD)
  return p.driver;
}

#else

Parts engine_parts() {
  Parts p;
  FABA_ENGINE_PARTS(FABA_ADD)
  return p;
}

#endif
#undef FABA_ADD

}  // namespace faba
