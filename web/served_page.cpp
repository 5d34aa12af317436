#include "web/served_page.h"

#include <sys/stat.h>

#include "base/files.h"

namespace shaken::web {
namespace {

std::filesystem::path address_file(const std::filesystem::path& root) { return root / "web.address"; }

}  // namespace

Result<ServedPage> ServedPage::claim(const std::filesystem::path& root) {
  return ServedPage(address_file(root), SHAKEN_TRY(run::DirectoryLock::acquire(root / "web.lock")));
}

ServedPage::~ServedPage() {
  std::error_code ignored;
  if (!file_.empty()) std::filesystem::remove(file_, ignored);
}

Result<void> ServedPage::announce(const std::string& address) const {
  const mode_t before = umask(0077);
  Result<void> written = write_file_atomically(file_, address + "\n");
  umask(before);
  return written;
}

std::optional<std::string> served_address(const std::filesystem::path& root) {
  const Result<std::string> text = read_file(address_file(root));
  if (!text || !text->starts_with("http://127.0.0.1:")) return std::nullopt;
  return text->substr(0, text->find('\n'));
}

}  // namespace shaken::web
