// What a terminal sends: keys, in any order and in pieces.
#include "client/watch/keys.h"
#include "tests/fuzz/fuzz_target.h"

using namespace shaken;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  client::KeyReader whole, in_pieces;
  const std::vector<client::Key> keys = whole.add(text);
  std::vector<client::Key> pieces;
  for (const char byte : text) {
    for (const client::Key& key : in_pieces.add({&byte, 1})) pieces.push_back(key);
  }
  fuzz::promise(keys == pieces, "keys do not depend on the pieces in which they come");
  return 0;
}
