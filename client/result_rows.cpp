// SPDX-License-Identifier: MIT
#include "client/result_rows.h"

namespace shaken::client {

std::vector<ResultRow> result_rows(Session& session, const Target& target) {
  const Json answer = session.get("/v1/results?sweep=" + url_encoded(target.sweep_id()));
  std::vector<ResultRow> rows;
  for (const Json& row : answer.at("rows")) {
    if (target.is_sweep || row.at("job") == target.answer.at("job").at("id")) rows.push_back(result_row(row));
  }
  return rows;
}

}  // namespace shaken::client
