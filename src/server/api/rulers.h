#pragma once
#include <filesystem>
#include <string>

#include "server/api/lab_services.h"

namespace faba {

/// Measures the image scale in a picture of a ruler whose marks are `tick_um` apart. Unless the quality is
/// poor, saves the calibration and the picture in the workspace as `name` with their extensions. The response
/// of `faba scale --json` with the `url` of a picture of the detected marks, and `file` if it was saved.
/// Throws Error(usage) for a distance out of range, Error(input) if no marks are found.
Json measure_ruler(const LabServices& lab, const std::filesystem::path& picture, double tick_um,
                   const std::string& name, const std::string& extension);

}  // namespace faba
