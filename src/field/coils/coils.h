#pragma once
#include "field/field.h"

namespace faba {

/// Every kind of coil: what [[coil]] in a rig can be, and a field of its own in a scenario.
void add_coils(FieldRegistry& r);
void add_rig(FieldRegistry& r);
const FieldRegistry& coil_kinds();

}  // namespace faba
