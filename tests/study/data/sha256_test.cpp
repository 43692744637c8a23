#include "study/data/sha256.h"

#include <doctest/doctest.h>

using namespace faba;

// Examples of FIPS 180-4.
TEST_CASE("SHA-256 of known messages") {
  const auto digest = [](const std::string& text) {
    Sha256 s;
    s.add(text);
    return s.hex();
  };
  CHECK(digest("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(digest("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(digest(std::string(1000000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 does not depend on how the message is divided") {
  for (const std::size_t length : {55U, 56U, 63U, 64U, 65U, 200U}) {
    const std::string text(length, 'x');
    Sha256 all, parts;
    all.add(text);
    for (const char c : text) parts.add({&c, 1});
    CHECK(all.hex() == parts.hex());
  }
}
