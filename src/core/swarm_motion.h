#pragma once

namespace faba {

/// How the mean of a swarm moves in a field: the plant of estimators and controllers, and of the design of
/// coils (theory F2). Of a typical cell of a model, or given by the user.
struct SwarmMotion {
  enum class Response {
    turning,       ///< cells swim at their own speed along a heading that the field turns
    proportional,  ///< the drift is proportional to the field, at once
    constant       ///< the drift has the direction of the field and one speed, at once
  };
  Response response = Response::turning;
  double speed = 0;      ///< m/s, of aligned cells; turning and constant
  double turning = 0;    ///< turning: rate of turning per tesla, m / f_r, rad/(s T)
  double diffusion = 0;  ///< turning: rotational diffusion coefficient, 1/s
  double mobility = 0;   ///< proportional: drift per tesla, m/(s T)
  double spread = 0;  ///< translational diffusion coefficient of a cell, m^2/s, without that of its heading
};

}  // namespace faba
