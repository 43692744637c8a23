#include "app/scenario/sections/library.h"

#include <filesystem>

#include "core/hash.h"

namespace faba {

Schema<LibraryParams> LibraryParams::schema() {
  return Schema<LibraryParams>("library", "A field library, as `faba field library` makes it for the rig")
      .add("file", &LibraryParams::file,
           {.doc = "HDF5 file; beside the scenario, or where the program is called. The field is then taken "
                   "at the "
                   "nodes of its grid"})
      .add(
          "made", &LibraryParams::made,
          {.doc = "What the library is told by; filled in from the file, and refused when it is another one"})
      .check([](const LibraryParams& p) -> std::string {
        return p.file.empty() ? "needs file = \"a library's HDF5 file\"" : "";
      });
}

Json LibraryParams::hashed() const {
  Json j = schema().to_json(*this);
  j.erase("file");
  return j;
}

LibraryParams read_library(const Node& root, const Readers& readers) {
  const Node n = root.child("library");
  if (!readers.library || !readers.library_task) n.fail("this build of the program does not read HDF5");
  LibraryParams p = LibraryParams::schema().parse(n);
  p.file = std::filesystem::absolute(n.file(p.file)).lexically_normal().string();
  Hash h;
  h.text(readers.library_task(p.file));
  if (!p.made.empty() && p.made != h.hex())
    throw Error(Errc::input, p.file, "is another library than the one that this scenario was made with");
  p.made = h.hex();
  return p;
}

}  // namespace faba
