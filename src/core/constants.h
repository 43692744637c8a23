#pragma once

namespace faba {

/// Boltzmann constant, J/K; exact in the SI.
inline constexpr double kBoltzmann = 1.380649e-23;

}  // namespace faba
