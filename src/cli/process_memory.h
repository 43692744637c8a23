#pragma once

namespace faba::cli {

/// Freed memory of pictures stays with the process: to return it and request it again for every frame, or for
/// every simulation of a study, takes a tenth of the time, because the kernel clears each page.
void keep_freed_memory();

}  // namespace faba::cli
