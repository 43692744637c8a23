#include "app/scenario/parts.h"

namespace faba {

// To add a part: write its file, add its line here.
#define FABA_PARTS(X)              \
  X(model, basic)                  \
  X(model, adapted)                \
  X(model, dipole)                 \
  X(start, start_uniform)          \
  X(start, start_visible)          \
  X(start, start_edge)             \
  X(start, start_disc)             \
  X(start, start_places)           \
  X(arena, box)                    \
  X(arena, drop)                   \
  X(field, uniform)                \
  X(field, coils)                  \
  X(field, rig)                    \
  X(motility, motility_none)       \
  X(motility, motility_thesis)     \
  X(estimator, mean)               \
  X(estimator, visible)            \
  X(estimator, estimator_none)     \
  X(estimator, image)              \
  X(estimator, groups)             \
  X(reference, none)               \
  X(reference, hold)               \
  X(reference, route)              \
  X(controller, manual)            \
  X(controller, fuzzy)             \
  X(controller, proportional)      \
  X(controller, gradient)          \
  X(controller, gradient_feedback) \
  X(flow, horn_schunck)            \
  X(flow, dis)                     \
  X(flow, farneback)

#define X(kind, name) void add_##name(decltype(Parts::kind)&);
FABA_PARTS(X)
#undef X

Parts builtin_parts() {
  Parts p;
#define X(kind, name) add_##name(p.kind);
  FABA_PARTS(X)
#undef X
  return p;
}

}  // namespace faba
