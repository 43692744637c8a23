#pragma once
#include <vector>

#include "study/identify/identify_study.h"

namespace faba {

/// Properties of any culture that a candidate neither frees nor fixes, as free parameters with wide priors:
/// motile fraction, responsive fraction, and spread of the speed. `scenario`: of the candidate, without its
/// free parameters. At most as many as the limit of free parameters permits.
std::vector<FreeParameter> default_nuisances(const Candidate& c, const Json& scenario);

}  // namespace faba
