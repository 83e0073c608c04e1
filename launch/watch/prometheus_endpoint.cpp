// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/prometheus_endpoint.h"

#include <prometheus/collectable.h>
#include <prometheus/exposer.h>

#include <charconv>
#include <exception>

#include "common/base/error.h"
#include "common/base/mutex.h"
#include "launch/watch/listen_address.h"
#include "launch/watch/prometheus_families.h"

namespace shoal::launch {
namespace {

constexpr size_t kThreads = 2;
constexpr char kOption[] = "--prometheus";

ListenAddress Parse(const std::string& where) {
  ListenAddress listen;
  const size_t colon = where.rfind(':');
  if (colon != std::string::npos) listen.address = where.substr(0, colon);
  const char* begin = where.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* end = where.data() + where.size();
  const auto [stop, error] = std::from_chars(begin, end, listen.port);
  if (error != std::errc() || stop != end || listen.port == 0 || !IsAddress(listen.address)) {
    throw UsageError("--prometheus {}: expected PORT or ADDRESS:PORT, a port from 1 to 65535",
                     where);
  }
  return listen;
}

// Answers a scrape with the newest view.
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
  CheckCanListen(listen, kOption);
  try {
    return std::make_unique<prometheus::Exposer>(listen.Text(), kThreads);
  } catch (const std::exception& e) {
    throw RuntimeError("{}: cannot listen on {}: {}", kOption, listen.Text(), e.what());
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

void PrometheusEndpoint::Check(const std::string& where) { CheckCanListen(Parse(where), kOption); }

std::string PrometheusEndpoint::Url() const {
  return fmt::format("http://{}/metrics", impl_->listen.Text());
}

void PrometheusEndpoint::Update(const RunViewMessage& view) { impl_->page->Update(view); }

}  // namespace shoal::launch
