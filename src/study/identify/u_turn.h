#pragma once
#include "core/toml.h"

namespace faba {

/// Duration of the U-turn of a dipole after a field reversal, s: f_r / (m B) ln(4 m B / kT), until the
/// alignment with the field is limited by thermal noise (theory B3). `model` is the table of the model;
/// missing keys have their defaults. `moment` in A m^2, `field_t` in T. Infinite for 4 m B <= kT.
double u_turn_s(const Json& model, double moment, double field_t);

}  // namespace faba
