# Options of the compiler em++ of Emscripten.
add_compile_options(-msimd128 -fexceptions)
add_link_options(-fexceptions)
# Sizes in files have 64 bits, std::size_t has 32. Loops that clang 14 does not vectorise have the same results.
target_compile_options(faba_flags INTERFACE -Wno-shorten-64-to-32 -Wno-pass-failed)

# The libraries of faba_engine for Emscripten. They have headers only, of which those of this machine are used: links to
# them are in a folder of the build, because the other headers of /usr/include are those of another C library.
set(FABA_HEADER_LINKS ${CMAKE_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${FABA_HEADER_LINKS})
foreach(header fmt nlohmann toml++ nanoflann.hpp boost eigen3/Eigen eigen3/unsupported)
  find_path(folder_of_${header} ${header} PATHS /usr/include /usr/local/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH REQUIRED)
  get_filename_component(name ${header} NAME)
  file(CREATE_LINK ${folder_of_${header}}/${header} ${FABA_HEADER_LINKS}/${name} SYMBOLIC)
endforeach()
set(BOOST_INCLUDE ${FABA_HEADER_LINKS})
foreach(target fmt::fmt nlohmann_json::nlohmann_json Eigen3::Eigen Threads::Threads)
  add_library(${target} INTERFACE IMPORTED)
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${FABA_HEADER_LINKS})
endforeach()
set_target_properties(fmt::fmt PROPERTIES INTERFACE_COMPILE_DEFINITIONS FMT_HEADER_ONLY)
