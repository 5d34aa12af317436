#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shaken::client {

/// A key that was pressed.
struct Key {
  enum class Kind { kCharacter, kUp, kDown, kLeft, kRight, kBackTab, kEscape };
  Kind kind = Kind::kCharacter;
  char character = 0;  ///< of kCharacter, ASCII; Tab is '\t', Ctrl-L '\f'
  friend bool operator==(const Key&, const Key&) = default;
};

/// Turns what a terminal sends into keys. Keys that Shaken does not know vanish
/// whole, so that no part of them is taken for a letter.
class KeyReader {
 public:
  /// The keys that `bytes` complete; the beginning of a sequence waits for its end.
  std::vector<Key> add(std::string_view bytes);
  /// Nothing more has come for a while: a lone escape byte was the key Esc.
  std::vector<Key> flush();
  bool is_waiting() const { return !rest_.empty(); }

 private:
  std::string rest_;
};

}  // namespace shaken::client
