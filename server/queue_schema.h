// SPDX-License-Identifier: MIT
#pragma once

#include "server/sqlite.h"

namespace shaken::server {

/// Creates the queue's tables in an empty file. Throws StorageError if the file is damaged, or has tables of another
/// version than this program's.
void prepare_schema(Database& database);

}  // namespace shaken::server
