#include "app/scenario/sections/library.h"

#include <filesystem>

#include "core/hash.h"

namespace faba {

Schema<LibraryParams> LibraryParams::schema() {
  return Schema<LibraryParams>("library",
                               "A field library for the coil system, written by `faba field library`")
      .add("file", &LibraryParams::file,
           {.doc = "HDF5 file, relative to the scenario or to the working directory. The simulation uses the "
                   "field "
                   "at the nodes of its grid"})
      .add("made", &LibraryParams::made,
           {.doc = "Hash of the library, set from the file; a library with another hash is rejected"})
      .check([](const LibraryParams& p) -> std::string {
        return p.file.empty() ? "key \"file\" is missing; give the HDF5 file of a library" : "";
      });
}

Json LibraryParams::hashed() const {
  Json j = schema().to_json(*this);
  j.erase("file");
  return j;
}

LibraryParams read_library(const Node& root, const Readers& readers) {
  const Node n = root.child("library");
  if (!readers.library || !readers.library_task) n.fail("this build of the program cannot read HDF5");
  LibraryParams p = LibraryParams::schema().parse(n);
  p.file = std::filesystem::absolute(n.file(p.file)).lexically_normal().string();
  Hash h;
  h.text(readers.library_task(p.file));
  if (!p.made.empty() && p.made != h.hex())
    throw Error(Errc::input, p.file, "is not the library with which this scenario was created");
  p.made = h.hex();
  return p;
}

}  // namespace faba
