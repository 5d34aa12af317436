// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shaken::client {

/// A key that was pressed.
struct Key {
  enum class Kind { kCharacter, kUp, kDown, kLeft, kRight, kBackTab, kEscape };
  Kind kind = Kind::kCharacter;
  char character = 0;  ///< of kCharacter, ASCII; Tab is '\t', Ctrl-L '\f'
  friend bool operator==(const Key&, const Key&) = default;
};

/// Turns what a terminal sends into keys, and keeps its answers apart from them. Keys that Shaken does not know vanish
/// whole, so that no part of them is taken for a letter.
class KeyReader {
 public:
  /// The keys that `bytes` complete; the beginning of a sequence waits for its end.
  std::vector<Key> add(std::string_view bytes);
  /// Nothing more has come for a while: a lone escape byte was the key Esc.
  std::vector<Key> flush();
  bool is_waiting() const { return !rest_.empty(); }
  /// Whether it waits for the end of an answer, which may take longer than that of a key.
  bool is_in_answer() const { return is_waiting() && rest_.starts_with("\x1b_G"); }
  /// What the terminal has answered to questions: whole sequences, in order, each once.
  std::vector<std::string> take_answers() { return std::exchange(answers_, {}); }

 private:
  std::string rest_;
  std::vector<std::string> answers_;
};

}  // namespace shaken::client
