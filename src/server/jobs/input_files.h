#pragma once
#include "server/workspace.h"

namespace faba {

/// The files of the workspace from which a page chooses the inputs of jobs, newest first: "file", "kind"
/// ("video", "picture", "table", "coil_system", "study", "scene", "experiment"), "bytes" and "time" (of the
/// last change, s since 1970). A study also has its "verb", a coil system "coils" and "currents", an
/// experiment "title", and a recorded run "run": true. Hidden files, and folders deeper than five levels, are
/// not searched.
Json input_files(const Workspace& workspace);

}  // namespace faba
