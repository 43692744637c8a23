# Toolchain file: Debian's cross compiler for arm64 (aarch64-linux-gnu). Programs run with qemu-aarch64.
# Without FABA_SYSROOT, the C library of the cross compiler and header-only libraries of this machine (the engine). With
# FABA_SYSROOT, a folder with unpacked arm64 packages (tools/arm64_sysroot.sh) has all headers and libraries.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES FABA_SYSROOT)
set(CMAKE_CXX_FLAGS_INIT -Wno-psabi)  # notes about code of GCC 9 and older; all code here is of one compiler
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L /usr/aarch64-linux-gnu)
if(FABA_SYSROOT)
  set(CMAKE_SYSROOT ${FABA_SYSROOT})
  # A test program that starts arm64 programs needs the kernel's help (binfmt_misc), or is listed as skipped.
  set(CMAKE_CROSSCOMPILING_EMULATOR ${CMAKE_CURRENT_LIST_DIR}/../tools/emulate_arm64.sh ${FABA_SYSROOT})
  set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
  set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
  set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
  set(ENV{PKG_CONFIG_SYSROOT_DIR} ${FABA_SYSROOT})
  set(ENV{PKG_CONFIG_LIBDIR} ${FABA_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${FABA_SYSROOT}/usr/share/pkgconfig)
  set(PYTHON_MODULE_EXTENSION .cpython-311-aarch64-linux-gnu.so)  # pybind11 asks the Python of this machine
endif()
