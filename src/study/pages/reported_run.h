#pragma once
#include "app/bench/bench_session.h"
#include "app/recording/session.h"

namespace faba {

/// Runs a session and, if its end is reached, writes the report and completes the directory. Returns whether
/// the end was reached.
bool run_with_report(Session& session);

/// Runs a session on a bench and writes the report into its directory, also after an error if something was
/// recorded; the error then names the directory. Returns whether the end of the run was reached.
bool run_with_report(BenchSession& session);

}  // namespace faba
