#include "client/size.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "base/failure.h"
#include "base/text.h"

namespace shaken::client {

std::int64_t size_option(const std::string& option, const std::string& text) {
  constexpr std::array<std::pair<std::string_view, double>, 6> kUnits{
      {{"", 1}, {"B", 1}, {"kB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}}};
  constexpr double kMost = 1e18;
  double number = 0;
  const char* const text_end = text.data() + text.size();
  const auto [number_end, problem] = std::from_chars(text.data(), text_end, number, std::chars_format::fixed);
  std::string_view unit(number_end, static_cast<std::size_t>(text_end - number_end));
  if (unit.starts_with(' ')) unit.remove_prefix(1);
  for (const auto& [name, bytes] : kUnits) {
    if (problem == std::errc() && unit == name && number * bytes >= 1 && number * bytes <= kMost) {
      return static_cast<std::int64_t>(number * bytes);
    }
  }
  throw Failure(ExitCode::kBadInput,
                fmt::format("{}: '{}' is no size (write 500MB, 2GB or 64000)", option, printable(text)));
}

}  // namespace shaken::client
