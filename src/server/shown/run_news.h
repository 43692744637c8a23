#pragma once
#include <cstdint>

#include "core/toml.h"
#include "server/shown/shown_run.h"

namespace faba {

// Messages about the displayed run; web/protocol.md.

/// `run`: a run has started; `number` is that of the run.
Json run_news(const ShownRun& shown, std::uint32_t number);
/// `parts`: parts were exchanged.
Json parts_news(const ShownRun& shown);
/// `history`: the rows of the series so far.
Json history_news(const ShownRun& shown, std::uint32_t number);

}  // namespace faba
