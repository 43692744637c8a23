// The functions that the worker of the page calls: web/src/demo/worker.ts.
#include <emscripten.h>

#include <memory>

#include "demo/browser_lab.h"
#include "server/json_text.h"

// Messages to the page are passed to functions of the module that the worker sets.
EM_JS(void, send_text_to_page, (const char* text, size_t size), { Module.onText(UTF8ToString(text, size)); })
EM_JS(void, send_frame_to_page, (const char* bytes, size_t size),
      { Module.onFrame(HEAPU8.slice(bytes, bytes + size).buffer); })

namespace {

faba::BrowserLab& lab() {
  static faba::BrowserLab one(
      {[](const std::string& text) { send_text_to_page(text.data(), text.size()); },
       [](const std::string& bytes) { send_frame_to_page(bytes.data(), bytes.size()); },
       [] { return emscripten_get_now() / 1000; }},
      "scenes");
  return one;
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE void faba_open() { lab(); }

EMSCRIPTEN_KEEPALIVE void faba_receive(const char* text) { lab().receive(text); }

/// Times in s.
EMSCRIPTEN_KEEPALIVE double faba_advance(double budget) { return lab().advance(budget); }

/// The answer is valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* faba_answer(const char* path, const char* body) {
  static std::string text;
  text = faba::json_text(lab().answer(path, body));
  return text.c_str();
}
}
