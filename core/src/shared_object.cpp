#include "dismantle/shared_object.h"

#include <map>
#include <mutex>

namespace dismantle {

std::shared_ptr<void> shared_object(const std::string& name, const std::function<std::shared_ptr<void>()>& make) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<void>> objects;
  const std::scoped_lock lock(mutex);
  std::weak_ptr<void>& known = objects[name];
  std::shared_ptr<void> object = known.lock();
  if (object == nullptr) known = object = make();
  return object;
}

}  // namespace dismantle
