// SPDX-License-Identifier: MIT
// Conditions of `shaken results --where`.
#include "client/where.h"

#include "tests/fuzz/fuzz_target.h"

using namespace shaken;
using client::Json;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  auto where = client::Where::parse(text);
  if (!where) {
    fuzz::promise(!where.error().empty(), "a refusal says why");
    for (const auto& problem : where.error()) fuzz::promise(problem.at <= size, "a problem has a place in the text");
    // a caret and a message of each: of very many that is a long text
    if (where.error().size() < 100) (void)client::marked(text, where.error());
    return 0;
  }
  client::ResultRow done, queued;
  done.fields = Json{{"state", "done"}, {"order.mean", 0.75}, {"rods.length", 2.5}, {"steady", true}, {"n_rods", 7}};
  queued.fields = Json{{"state", "queued"}, {"rods.length", 4.5}};
  const auto problems = where->bind({done, queued});
  for (const auto& problem : problems) fuzz::promise(problem.at <= size, "a problem has a place in the text");
  if (problems.empty()) {
    (void)where->matches(done);
    (void)where->matches(queued);
    (void)where->lacking({done, queued});
  }
  return 0;
}
