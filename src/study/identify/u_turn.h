#pragma once
#include "core/toml.h"

namespace faba {

/// How long a dipole of a scenario takes to turn round when the field is reversed, s: f_r / (m B) ln(4 m B /
/// kT), after which it points along the field as well as heat lets it (theory B3). `model` is its table; what
/// is not in it is the model's default. `moment` in A m^2, `field_t` in T; infinite where heat is stronger
/// than the field.
double u_turn_s(const Json& model, double moment, double field_t);

}  // namespace faba
