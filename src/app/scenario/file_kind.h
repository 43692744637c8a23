#pragma once
#include <optional>

#include "core/toml.h"

namespace faba {

/// Kinds of TOML files that users write.
enum class FileKind {
  scenario,
  coil_system,
  identify_study,
  activity_study,
  controller_study,
  moment_study,
  calibration_study,
  control_benchmark
};

/// The kind that the keys of a document show; empty when they show none.
std::optional<FileKind> file_kind(const Node& root);

/// Throws Error(usage), with the command that reads the file, if the keys of the document show that it is of
/// another kind than `wanted`. A document of unknown kind is accepted: its reader names the missing keys.
void require_kind(const Node& root, FileKind wanted);

}  // namespace faba
