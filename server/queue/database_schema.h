// SPDX-License-Identifier: MIT
#pragma once

#include "server/queue/sqlite.h"

namespace shaken::server {

/// Creates the queue's tables in an empty file, and brings those of an older version up to this program's. Throws
/// StorageError if the file is damaged, or was written by a newer version.
void prepare_schema(Database& database);

}  // namespace shaken::server
