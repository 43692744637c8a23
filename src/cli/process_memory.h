#pragma once

namespace faba::cli {

/// Freed memory of pictures stays with the process: to return it and request it again for every frame, or for
/// every simulation of a study, takes a tenth of the time, because the kernel clears each page. The file also
/// has the program's operator new, which asks for large pages (docs/why.md).
void keep_freed_memory();

/// Ends the process without the destructors of static objects and libraries, which would only release memory.
[[noreturn]] void end_process(int code);

}  // namespace faba::cli
