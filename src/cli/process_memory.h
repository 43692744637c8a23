#pragma once

namespace faba::cli {

/// Freed memory of pictures stays with the process: to return it and request it again for every frame, or for
/// every simulation of a study, takes a tenth of the time, because the kernel clears each page. The file also
/// has the program's operator new, which asks for large pages (docs/why.md).
void keep_freed_memory();

}  // namespace faba::cli
