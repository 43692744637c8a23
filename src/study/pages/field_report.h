#pragma once
#include <nlohmann/json.hpp>

#include "study/coils/coil_design.h"
#include "study/coils/field_at.h"
#include "study/coils/field_fit.h"
#include "study/coils/field_library.h"
#include "study/coils/field_map.h"
#include "study/coils/field_tolerance.h"

namespace faba {

/// Output of `faba field ... --json`.
nlohmann::ordered_json field_json(const FieldAtPoints& f);
nlohmann::ordered_json field_json(const RigNull& n);
nlohmann::ordered_json field_json(const FieldMap& m);
/// For the editor of coil systems; see web/protocol.md.
nlohmann::ordered_json field_json(const CoilDesign& d);
nlohmann::ordered_json field_json(const FieldLibrarySummary& s);
nlohmann::ordered_json field_json(const FieldTolerance& t);
nlohmann::ordered_json field_json(const FieldFit& f);

}  // namespace faba
