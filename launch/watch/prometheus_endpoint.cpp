#include "launch/watch/prometheus_endpoint.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <prometheus/collectable.h>
#include <prometheus/exposer.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <exception>

#include "common/base/error.h"
#include "common/base/mutex.h"
#include "launch/watch/prometheus_families.h"

namespace shoal::launch {
namespace {

constexpr size_t kThreads = 2;

struct ListenAddress {
  std::string address = "127.0.0.1";
  uint16_t port = 0;
  std::string Text() const { return fmt::format("{}:{}", address, port); }
};

ListenAddress Parse(const std::string& where) {
  ListenAddress listen;
  const size_t colon = where.rfind(':');
  if (colon != std::string::npos) listen.address = where.substr(0, colon);
  const char* begin = where.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* end = where.data() + where.size();
  const auto [stop, error] = std::from_chars(begin, end, listen.port);
  in_addr parsed{};
  if (error != std::errc() || stop != end || listen.port == 0 ||
      inet_pton(AF_INET, listen.address.c_str(), &parsed) != 1) {
    throw UsageError("--prometheus {}: expected PORT or ADDRESS:PORT, a port from 1 to 65535",
                     where);
  }
  return listen;
}

// The server itself only knows that it failed, not why.
void CheckFree(const ListenAddress& wanted) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(wanted.port);
  inet_pton(AF_INET, wanted.address.c_str(), &address.sin_addr);
  const int reuse = 1;
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof(reuse));
  const bool bound = fd >= 0 &&
                     bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 &&
                     ::listen(fd, 1) == 0;
  const int reason = errno;
  if (fd >= 0) close(fd);
  if (!bound) {
    throw RuntimeError("--prometheus: cannot listen on {}: {}", wanted.Text(),
                       std::strerror(reason));
  }
}

// What a scrape gets: the newest view.
class Page final : public prometheus::Collectable {
 public:
  std::vector<prometheus::MetricFamily> Collect() const override {
    const MutexLock lock(mutex_);
    return PrometheusFamilies(view_);
  }
  void Update(const RunViewMessage& view) {
    const MutexLock lock(mutex_);
    view_ = view;
  }

 private:
  mutable Mutex mutex_;
  RunViewMessage view_ SHOAL_GUARDED_BY(mutex_);
};

std::unique_ptr<prometheus::Exposer> Listen(const ListenAddress& listen) {
  CheckFree(listen);
  try {
    return std::make_unique<prometheus::Exposer>(listen.Text(), kThreads);
  } catch (const std::exception& e) {
    throw RuntimeError("--prometheus: cannot listen on {}: {}", listen.Text(), e.what());
  }
}

}  // namespace

struct PrometheusEndpoint::Impl {
  explicit Impl(const std::string& where) : listen(Parse(where)), exposer(Listen(listen)) {
    exposer->RegisterCollectable(page);
  }

  const ListenAddress listen;
  const std::shared_ptr<Page> page = std::make_shared<Page>();
  std::unique_ptr<prometheus::Exposer> exposer;
};

PrometheusEndpoint::PrometheusEndpoint(const std::string& where)
    : impl_(std::make_unique<Impl>(where)) {}

PrometheusEndpoint::~PrometheusEndpoint() = default;

void PrometheusEndpoint::Check(const std::string& where) { CheckFree(Parse(where)); }

std::string PrometheusEndpoint::Url() const {
  return fmt::format("http://{}/metrics", impl_->listen.Text());
}

void PrometheusEndpoint::Update(const RunViewMessage& view) { impl_->page->Update(view); }

}  // namespace shoal::launch
