#pragma once

#include <stdexcept>
#include <string>

/// Guards a promise of our own, in every build; throws std::logic_error with the place and the condition.
#define SHAKEN_CHECK(condition, message)                                                                               \
  do {                                                                                                                 \
    if (!(condition)) {                                                                                                \
      throw std::logic_error(std::string(__FILE__ ":") + std::to_string(__LINE__) + ": " #condition ": " + (message)); \
    }                                                                                                                  \
  } while (false)
