#pragma once
#include <vector>

#include "study/identify/free_parameter.h"
#include "study/sweep/variant.h"

namespace faba {

/// Properties of any culture that a model neither frees nor fixes, as free parameters with wide priors:
/// motile fraction, responsive fraction, and spread of the speed. `free`: the free parameters of the study;
/// `scenario`: of the model, without them; `has_field`: whether a field is applied. At most as many as the
/// limit of free parameters permits.
std::vector<FreeParameter> default_nuisances(const std::vector<FreeParameter>& free, const Variant& model,
                                             bool has_field, const Json& scenario);

}  // namespace faba
