// SPDX-License-Identifier: MIT
// What a terminal sends: keys and answers, in any order and in pieces.
#include "client/watch/graphics.h"
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
  const std::vector<std::string> answers = whole.take_answers();
  fuzz::promise(answers == in_pieces.take_answers(), "nor do answers");
  client::TerminalAnswers heard;
  for (const std::string& answer : answers) heard.note(answer);
  fuzz::promise(heard.n_complete > 0 || heard.best() == client::Graphics::kBlocks,
                "nothing is believed before the end");
  if (!heard.window) return 0;
  if (const auto cell = client::cell_size(*heard.window, 80, 24)) {
    fuzz::promise(cell->width > 1 && cell->width <= 200 && cell->height > 1 && cell->height <= 200,
                  "sizes are bounded");
  }
  return 0;
}
