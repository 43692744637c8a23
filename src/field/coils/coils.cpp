#include "field/coils/coils.h"

namespace faba {

// To add a kind of coil: write its file, add its line here.
#define FABA_COILS(X) \
  X(loop)             \
  X(solenoid)         \
  X(thick_coil)       \
  X(dipole_coil)      \
  X(helmholtz)        \
  X(map)

#define X(name) void add_##name(FieldRegistry&);
FABA_COILS(X)
#undef X

void add_coils(FieldRegistry& r) {
#define X(name) add_##name(r);
  FABA_COILS(X)
#undef X
}

const FieldRegistry& coil_kinds() {
  static const FieldRegistry kinds = [] {
    FieldRegistry r{"coil", "A coil of a rig: [[coil]]"};
    add_coils(r);
    return r;
  }();
  return kinds;
}

}  // namespace faba
