// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/web_server.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <exception>
#include <map>
#include <thread>

#include "common/base/error.h"
#include "launch/record/run_folder.h"
#include "launch/tools/web/access.h"
#include "launch/tools/web/bounded_server.h"
#include "launch/tools/web/byte_range.h"
#include "launch/tools/web/page_answers.h"
#include "launch/tools/web/page_content.h"
#include "launch/tools/web/page_parts.h"
#include "launch/tools/web/page_route.h"
#include "launch/tools/web/served_file.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kJson[] = "application/json";
constexpr int kMostFiles = 4;  // served at once; the other threads serve the other requests

// The page runs only its own scripts. Inline styles are allowed for the plotting library.
constexpr char kPagePolicy[] =
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' "
    "data:; "
    "media-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";
// Files of a run are shown without running scripts, whatever they contain.
constexpr char kFilePolicy[] =
    "sandbox; default-src 'none'; style-src 'unsafe-inline'; img-src data:; media-src 'self' data:";

bool Acts(const httplib::Request& request) {
  return request.method != "GET" && request.method != "HEAD";
}

PageRoute RouteOf(const httplib::Request& request) {
  return ParsePageRoute(Acts(request), request.path);
}

void Refuse(int status, const std::string& message, httplib::Response& response) {
  response.status = status;
  response.set_content(ErrorAnswer(message), kJson);
}

// Adds the default headers of every answer.
void AddHeaders(httplib::Response& response) {
  if (!response.has_header("Content-Security-Policy")) {
    response.set_header("Content-Security-Policy", kPagePolicy);
  }
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_header("X-Frame-Options", "DENY");
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("Cross-Origin-Resource-Policy", "same-origin");
  response.set_header("Cache-Control", "no-store");
}

// Folder of the only run that is shown; empty = all runs of the folder.
fs::path OnlyRun(const WebOptions& options) {
  if (options.run.empty()) return {};
  return fs::weakly_canonical(FindNamed(options.run, RunsIn(options.run_dir)));
}

}  // namespace

struct WebServer::Impl {
  explicit Impl(const WebOptions& options);
  ~Impl();

  Caller CallerOf(const httplib::Request& request) const;
  // Refuses a caller without permission. Returns true if it has answered.
  bool TurnedAway(const httplib::Request& request, httplib::Response& response) const;
  void Answer(const httplib::Request& request, httplib::Response& response);
  void AnswerRoute(const PageRoute& route, const httplib::Request& request,
                   httplib::Response& response);
  void AnswerPart(const std::string& name, httplib::Response& response) const;
  void AnswerFile(std::optional<ServedFile> file, const httplib::Request& request,
                  httplib::Response& response);
  std::string CookieName() const { return fmt::format("{}_{}", kTokenCookie, listen.port); }

  ListenAddress listen;  // with the actual port
  const std::string token = MakeToken();
  const std::map<std::string, PagePart> parts = LoadPageParts();
  PageContent content;
  std::atomic<int> files = 0;  // being served
  std::atomic<bool> ended = false;
  BoundedServer server;
  std::thread thread;
};

WebServer::Impl::Impl(const WebOptions& options)
    : listen(options.listen),
      content({.run = OnlyRun(options), .run_dir = options.run_dir, .secure = options.secure}),
      server(ServerLimits(), [](const std::string& path) {
        const PageItem item = ParsePageRoute(/*acts=*/false, path).item;
        return item == PageItem::kFile || item == PageItem::kEpisode;
      }) {
  CheckCanListen(listen, "shoal web");
  server.set_pre_routing_handler([this](const auto& request, auto& response) {
    return TurnedAway(request, response) ? httplib::Server::HandlerResponse::Handled
                                         : httplib::Server::HandlerResponse::Unhandled;
  });
  const auto answer = [this](const auto& request, auto& response) { Answer(request, response); };
  server.Get(".*", answer);
  server.Post(".*", answer);
  server.set_post_routing_handler([](const auto&, auto& response) { AddHeaders(response); });
  const int port = listen.port == 0 ? server.bind_to_any_port(listen.address)
                   : server.bind_to_port(listen.address, listen.port) ? listen.port
                                                                      : -1;
  if (port <= 0) throw RuntimeError("shoal web: cannot listen on {}", listen.Text());
  listen.port = static_cast<uint16_t>(port);
  thread = std::thread([this] {
    server.listen_after_bind();
    ended = true;
  });
}

WebServer::Impl::~Impl() {
  server.EndConnections();
  // stop() does nothing before the thread has begun to listen.
  while (!server.is_running() && !ended) std::this_thread::yield();
  server.stop();
  thread.join();
}

Caller WebServer::Impl::CallerOf(const httplib::Request& request) const {
  return {
      .acts = Acts(request),
      .host = request.get_header_value("Host"),
      .origin = request.get_header_value("Origin"),
      .fetch_site = request.get_header_value("Sec-Fetch-Site"),
      .header_token = request.get_header_value(kTokenHeader),
      .cookie_token = std::string(CookieValue(request.get_header_value("Cookie"), CookieName())),
      .query_token = request.get_param_value(kTokenQuery)};
}

bool WebServer::Impl::TurnedAway(const httplib::Request& request,
                                 httplib::Response& response) const {
  const Caller caller = CallerOf(request);
  switch (Gate(listen, token).Decide(caller)) {
    case Access::kForeign:
      Refuse(
          403,
          "this request comes from another web site, or uses a host name that is not this server's",
          response);
      return true;
    case Access::kNoToken:
      Refuse(401, "the token is missing or wrong: open the address that shoal web printed",
             response);
      return true;
    case Access::kAllowed:
      break;
  }
  if (request.has_header("Content-Encoding")) {
    Refuse(415, "encoded bodies are not accepted", response);
    return true;
  }
  // The browser requests the parts of the page without the address's token, so a cookie carries it.
  if (!caller.query_token.empty() && EqualInConstantTime(caller.query_token, token)) {
    response.set_header(
        "Set-Cookie", fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", CookieName(), token));
  }
  return false;
}

void WebServer::Impl::Answer(const httplib::Request& request, httplib::Response& response) {
  const PageRoute route = RouteOf(request);
  try {
    AnswerRoute(route, request, response);
  } catch (const Error& e) {
    // The run does not run, or refuses the request: not a fault of the server.
    Refuse(e.exit_code() == 2 ? 400 : 409, e.what(), response);
  } catch (const std::exception& e) {
    Refuse(500, e.what(), response);
  }
}

void WebServer::Impl::AnswerRoute(const PageRoute& route, const httplib::Request& request,
                                  httplib::Response& response) {
  if (route.item == PageItem::kNothing) return Refuse(404, "there is no such page", response);
  if (route.item == PageItem::kPart) return AnswerPart(route.file, response);
  if (route.item == PageItem::kRuns) return response.set_content(content.Runs(), kJson);
  const auto run = content.FindRun(route.run);
  if (!run) return Refuse(404, fmt::format("there is no run '{}'", route.run), response);
  switch (route.item) {
    case PageItem::kRun:
      return response.set_content(content.Run(*run), kJson);
    case PageItem::kTop:
      return response.set_content(content.Top(*run), kJson);
    case PageItem::kCurves:
      return response.set_content(content.Curves(*run), kJson);
    case PageItem::kOrder:
      return response.set_content(content.Carry(*run, request.body), kJson);
    case PageItem::kPlay:
      return response.set_content(content.Play(*run), kJson);
    case PageItem::kEpisode: {
      const fs::path film = content.EpisodeFilm(*run);
      return AnswerFile(film.empty() ? std::nullopt : OpenWholeFile(film, "video/mp4"), request,
                        response);
    }
    default:
      return AnswerFile(OpenServedFile(*run, route.file), request, response);
  }
}

void WebServer::Impl::AnswerPart(const std::string& name, httplib::Response& response) const {
  const auto part = parts.find(name);
  if (part == parts.end()) return Refuse(404, "there is no such page", response);
  response.set_content(part->second.content, part->second.type.c_str());
}

void WebServer::Impl::AnswerFile(std::optional<ServedFile> file, const httplib::Request& request,
                                 httplib::Response& response) {
  if (!file) return Refuse(404, "there is no such film, report or picture", response);
  response.set_header("Content-Security-Policy", kFilePolicy);
  response.set_header("Accept-Ranges", "bytes");
  ByteRange range{.offset = 0, .bytes = file->bytes};
  const RangeAsked asked = ParseByteRange(request.get_header_value("Range"), file->bytes, &range);
  if (asked == RangeAsked::kOutside) {
    response.set_header("Content-Range", fmt::format("bytes */{}", file->bytes));
    return Refuse(416, "the file ends before that", response);
  }
  if (asked == RangeAsked::kPart) {
    response.status = 206;
    response.set_header("Content-Range", fmt::format("bytes {}-{}/{}", range.offset,
                                                     range.offset + range.bytes - 1, file->bytes));
  }
  if (range.bytes == 0) return response.set_content("", file->type);
  if (++files > kMostFiles) {
    --files;
    return Refuse(503, "too many files are being read: ask again", response);
  }
  const std::shared_ptr<void> turn(nullptr, [this](void*) { --files; });
  const auto open = std::make_shared<ServedFile>(*std::move(file));
  response.set_content_provider(
      range.bytes, open->type,
      [open, turn, range](size_t offset, size_t length, httplib::DataSink& sink) {
        std::array<char, 65536> part{};
        const ssize_t n = pread(open->file.get(), part.data(), std::min(length, part.size()),
                                static_cast<off_t>(range.offset + offset));
        return n > 0 && sink.write(part.data(), static_cast<size_t>(n));
      });
}

WebServer::WebServer(const WebOptions& options) : impl_(std::make_unique<Impl>(options)) {}

WebServer::~WebServer() = default;

uint16_t WebServer::port() const { return impl_->listen.port; }

const std::string& WebServer::token() const { return impl_->token; }

std::string WebServer::Url() const {
  ListenAddress shown = impl_->listen;
  std::array<char, 256> name{};
  // The server listens on all addresses of this host, so show the host's name.
  if (shown.address == "0.0.0.0" && gethostname(name.data(), name.size() - 1) == 0) {
    shown.address = name.data();
  }
  return fmt::format("http://{}/?{}={}", shown.Text(), kTokenQuery, impl_->token);
}

void WebServer::Tend() { impl_->content.Tend(); }

}  // namespace shoal::launch
