#include "base/keys/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "base/core/check.h"

namespace shaken::keys {

namespace {

constexpr std::size_t kMaxDepth = 64;  // far more than any scene has; keeps recursion over the tree shallow

/// Walks through a text once and says at which line and column each token starts.
class Cursor {
 public:
  Cursor(std::string_view text, std::shared_ptr<const std::string> file) : text_(text), file_(std::move(file)) {
    if (text_.starts_with("\xef\xbb\xbf")) offset_ = 3;  // byte order mark
  }

  Place place() const { return {file_, line_, column_}; }
  std::size_t offset() const { return offset_; }

  void advance_to(std::size_t offset) {
    for (; offset_ < std::min(offset, text_.size()); ++offset_) {
      const auto c = static_cast<unsigned char>(text_[offset_]);
      if (c == '\n') {
        ++line_;
        column_ = 1;
      } else if ((c & 0xc0) != 0x80) {  // not a continuation byte of UTF-8
        ++column_;
      }
    }
  }

  /// Moves to the start of the next key or value, over white space, punctuation and comments.
  void to_next_token() {
    while (offset_ < text_.size()) {
      if (starts("//")) {
        advance_to(std::min(text_.find_first_of(kLineEnds, offset_), text_.size() - 1) + 1);
      } else if (starts("/*")) {
        advance_to(std::min(text_.find("*/", offset_ + 2), text_.size()) + 2);
      } else if (std::string_view(" \t\r\n,:]}").find(text_[offset_]) != std::string_view::npos) {
        advance_to(offset_ + 1);
      } else {
        return;
      }
    }
  }

  /// Moves past the token here, known to be well formed, and returns its text.
  std::string_view take_token() {
    const std::size_t start = offset_;
    std::size_t end = start + 1;
    if (text_[start] == '"') {
      while (end < text_.size() && text_[end] != '"') end += text_[end] == '\\' ? 2 : 1;
      SHAKEN_CHECK(end < text_.size(), "a string that the parser has read ends");
      ++end;
    } else if (text_[start] != '{' && text_[start] != '[') {
      end = std::min(text_.find_first_of(" \t\r\n,:]}/", start), text_.size());
    }
    advance_to(end);
    return text_.substr(start, end - start);
  }

 private:
  /// What ends a comment, as the parser sees it: a carriage return alone does, too.
  static constexpr std::string_view kLineEnds = "\n\r";

  bool starts(std::string_view what) const { return text_.substr(offset_).starts_with(what); }

  std::string_view text_;
  std::shared_ptr<const std::string> file_;
  std::size_t offset_ = 0;
  int line_ = 1;
  int column_ = 1;
};

/// What nlohmann's parser calls for each token; grows the tree of nodes.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(std::string_view text, std::shared_ptr<const std::string> file, std::vector<Problem>& problems)
      : text_(text), file_(std::move(file)), cursor_(text, file_), problems_(problems) {}

  bool null() override { return add(Node::Kind::kNull); }
  bool boolean(bool value) override { return add(Node::Kind::kBoolean, {}, value); }
  bool number_integer(number_integer_t) override { return add(Node::Kind::kNumber); }
  bool number_unsigned(number_unsigned_t) override { return add(Node::Kind::kNumber); }
  bool number_float(number_float_t, const string_t&) override { return add(Node::Kind::kNumber); }
  bool string(string_t& value) override { return add(Node::Kind::kString, std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Node::Kind::kObject); }
  bool start_array(std::size_t) override { return open(Node::Kind::kArray); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    cursor_.to_next_token();
    const Place place = cursor_.place();
    cursor_.take_token();
    const auto [first, is_new] = open_.back().keys.try_emplace(value, place);
    if (!is_new) {
      problems_.push_back(
          problem_at(place, child_path(value),
                     fmt::format("duplicate key, first given at {}:{}", first->second.line, first->second.column)));
    }
    open_.back().is_duplicate = !is_new;
    open_.back().key = std::move(value);
    open_.back().key_place = place;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    // The last character read, or the start of the word or number that it belongs to.
    std::size_t at = std::min(position - std::min<std::size_t>(position, 1), text_.size());
    const auto in_word = [&](std::size_t i) {
      const auto c = static_cast<unsigned char>(text_[i]);
      return std::isalnum(c) != 0 || c == '-' || c == '+' || c == '.';
    };
    while (at < text_.size() && in_word(at) && at > 0 && in_word(at - 1)) --at;
    Cursor cursor(text_, file_);
    cursor.advance_to(at);
    problems_.push_back(problem_at(cursor.place(), {}, explain(text_.substr(at), error.what())));
    return false;
  }

  std::optional<Node> take_root() { return std::move(root_); }

 private:
  /// A container whose end has not been met.
  struct Open {
    Node node;
    std::string key;  ///< the key whose value is next
    Place key_place;
    bool is_duplicate = false;                    ///< whether that key has a value already
    std::unordered_map<std::string, Place> keys;  ///< all so far
  };

  static std::string explain(std::string_view rest, std::string_view what) {
    for (const std::string_view word : {"NaN", "nan", "Infinity", "-Infinity", "inf", "-inf"}) {
      if (rest.starts_with(word)) return fmt::format("syntax error: {} is not a number", word);
    }
    // "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ... - unexpected ..."
    const std::size_t place_end = what.find(": ");
    std::string_view reason = place_end == std::string_view::npos ? what : what.substr(place_end + 2);
    if (const std::size_t bracket = reason.find("] "); reason.starts_with("[")) reason.remove_prefix(bracket + 2);
    constexpr std::string_view kPrefix = "syntax error ";
    if (reason.starts_with(kPrefix)) reason.remove_prefix(kPrefix.size());
    // "; last read: '...'" quotes half of the text; the place says it better.
    const std::size_t quote = reason.find("; last read: ");
    const std::size_t after = reason.rfind("; expected ");
    const bool goes_on = after != std::string_view::npos && quote != std::string_view::npos && after > quote;
    return fmt::format("syntax error {}{}", reason.substr(0, quote), goes_on ? reason.substr(after) : "");
  }

  std::string child_path(std::string_view key) const {
    std::string path;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) path += open_[i].key + ".";
    return path.append(key);
  }

  Node next_node(Node::Kind kind) {
    cursor_.to_next_token();
    Node node;
    node.kind = kind;
    node.place = cursor_.place();
    return node;
  }

  bool add(Node::Kind kind, std::string text = {}, bool boolean = false) {
    Node node = next_node(kind);
    const std::string_view token = cursor_.take_token();
    node.text = kind == Node::Kind::kNumber ? std::string(token) : std::move(text);
    node.boolean = boolean;
    return attach(std::move(node));
  }

  bool attach(Node node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return true;
    }
    Open& parent = open_.back();
    if (parent.node.kind == Node::Kind::kArray) {
      parent.node.items.push_back(std::move(node));
    } else if (!parent.is_duplicate) {
      parent.node.members.push_back({parent.key, parent.key_place, std::move(node)});
    }
    return true;
  }

  bool open(Node::Kind kind) {
    Open container{next_node(kind), {}, {}, false, {}};
    cursor_.take_token();
    if (open_.size() == kMaxDepth) {
      problems_.push_back(problem_at(container.node.place, {}, fmt::format("nested more than {} deep", kMaxDepth)));
      return false;
    }
    open_.push_back(std::move(container));
    return true;
  }

  bool close() {
    Node node = std::move(open_.back().node);
    open_.pop_back();
    return attach(std::move(node));
  }

  std::string_view text_;
  std::shared_ptr<const std::string> file_;
  Cursor cursor_;
  std::vector<Problem>& problems_;
  std::vector<Open> open_;
  std::optional<Node> root_;
};

}  // namespace

const Member* Node::find(std::string_view key) const {
  const auto found = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.key == key; });
  return found == members.end() ? nullptr : &*found;
}

std::optional<Node> parse_document(std::string_view text, const std::string& file, std::vector<Problem>& problems) {
  const auto name = std::make_shared<const std::string>(file);
  // nlohmann's parser takes a NUL for the end of the text.
  if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
    Cursor cursor(text, name);
    cursor.advance_to(nul);
    problems.push_back(problem_at(cursor.place(), {}, "syntax error: NUL character"));
    return std::nullopt;
  }
  TreeBuilder builder(text, name, problems);
  constexpr bool kStrict = true;
  constexpr bool kIgnoreComments = true;
  if (!nlohmann::json::sax_parse(text, &builder, nlohmann::json::input_format_t::json, kStrict, kIgnoreComments)) {
    return std::nullopt;
  }
  return builder.take_root();
}

bool is_link_to_schema(const Member& member, std::vector<Problem>& problems) {
  if (member.key != "$schema") return false;
  if (member.value.kind != Node::Kind::kString) {
    problems.push_back(problem_at(member.value.place, member.key, "expected a text, not " + describe(member.value)));
  }
  return true;
}

std::string describe(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kNull:
      return "null";
    case Node::Kind::kBoolean:
      return node.boolean ? "true" : "false";
    case Node::Kind::kNumber:
      return fmt::format("the number {}", node.text);
    case Node::Kind::kString:
      return fmt::format("the text \"{}\"", node.text);
    case Node::Kind::kArray:
      return "an array";
    case Node::Kind::kObject:
      return "an object";
  }
  return "";
}

}  // namespace shaken::keys
