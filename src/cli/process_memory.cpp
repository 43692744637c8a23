#include "cli/process_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <new>

#ifdef __GLIBC__  // defined by the headers above
#include <malloc.h>
#endif

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FABA_OWN_MEMORY
#endif

namespace {

constexpr std::size_t kPicture = std::size_t(1) << 20;    // bytes, of a small one
constexpr std::size_t kSeparate = std::size_t(32) << 20;  // bytes of a block outside of the heap
constexpr std::size_t kHeapStep = std::size_t(64) << 20;  // bytes

#ifdef MADV_HUGEPAGE
constexpr std::uintptr_t kPage = std::uintptr_t(2) << 20;  // bytes of a large page on x86-64 and arm64

std::atomic<char*> heap_with_large_pages = nullptr;  // its end

// The kernel gives and clears the memory of pictures in large pages, and not in 500 times as many steps.
// Asked for when the heap has grown: where memory was used before, its pages stay small. An error means that
// this kernel has no large pages.
void prefer_large_pages(void* block, std::size_t size) {
  const auto advise = [](char* begin, const char* end) {
    begin -= reinterpret_cast<std::uintptr_t>(begin) % kPage;
    madvise(begin, std::size_t(end - begin), MADV_HUGEPAGE);
  };
  char* const begin = static_cast<char*>(block);
  if (size >= kSeparate) return advise(begin, begin + size);
  char* const end = static_cast<char*>(sbrk(0));
  char* const before = heap_with_large_pages.exchange(end);
  if (end > std::max(before, begin)) advise(std::max(before, begin), end);
}
#else
void prefer_large_pages(void*, std::size_t) {}
#endif

}  // namespace

namespace faba::cli {

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, int(kSeparate));  // the largest permitted value
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, int(kHeapStep));
  mallopt(M_ARENA_MAX, 1);  // memory that a thread has freed is used by all
  // The heap grows now, so that small blocks and those of libraries are in large pages, too.
  void* const picture = std::malloc(kPicture);
  prefer_large_pages(picture, kPicture);
  std::free(picture);
#endif
}

void end_process(int code) {
  std::cout.flush();
  std::fflush(nullptr);
#ifdef FABA_OWN_MEMORY
  std::_Exit(code);
#else
  std::exit(code);  // the leak check
#endif
}

}  // namespace faba::cli

// The allocation functions of the program; those for arrays call them. Sanitizers have their own.
#ifdef FABA_OWN_MEMORY
void* operator new(std::size_t size) {
  for (;;) {
    if (void* memory = std::malloc(size > 0 ? size : 1)) {
      if (size >= kPicture) prefer_large_pages(memory, size);
      return memory;
    }
    const std::new_handler free_some = std::get_new_handler();
    if (free_some == nullptr) throw std::bad_alloc();
    free_some();
  }
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
#endif
