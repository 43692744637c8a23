#include "server/web_server.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <limits>
#include <optional>

#include "core/error.h"
#include "server/files/disk_space.h"
#include "server/files/opened_path.h"
#include "server/page_socket.h"
#include "server/web_request.h"

namespace faba {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

namespace {

constexpr std::size_t kMostHeader = 16u << 10;
constexpr auto kRequestTimeout = std::chrono::seconds(30);  // timeout of a request and of a response
constexpr std::uint64_t kLeastRate = 16u << 10;             // bytes/s, mean of an upload
constexpr std::uint64_t kMostOfRange = 8u << 20;            // maximum size of a range response

// Only scripts and resources of this server.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; media-src 'self' "
    "blob:; connect-src 'self'; font-src 'self'; frame-src 'self'; manifest-src 'self'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'self'";
// Files of the user, such as reports: inline style, no script.
constexpr const char* kReportPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src 'self' data:; media-src 'self' data:; base-uri "
    "'none'; form-action 'none'; frame-ancestors 'self'";

using Header = http::request_header<>;

std::vector<std::string> values(const Header& h, http::field name) {
  std::vector<std::string> out;
  const auto [from, to] = h.equal_range(name);
  for (auto it = from; it != to; ++it) out.emplace_back(it->value());
  return out;
}

Credentials credentials_of(const Header& h, const std::optional<WebTarget>& target) {
  Credentials c;
  c.method = std::string(h.method_string());
  c.host = values(h, http::field::host);
  c.origin = values(h, http::field::origin);
  c.cookie = values(h, http::field::cookie);
  c.authorization = values(h, http::field::authorization);
  for (const auto& field : h)
    if (beast::iequals(field.name_string(), "Sec-Fetch-Site")) c.fetch_site.emplace_back(field.value());
  c.content_type = std::string(h[http::field::content_type]);
  c.upgrade = beast::iequals(h[http::field::upgrade], "websocket");
  if (target)
    if (const auto it = target->query.find("token"); it != target->query.end()) c.query_token = it->second;
  return c;
}

template <class Body>
void set_headers(http::response<Body>& r, const std::string& type, bool keep, bool report = false) {
  r.set(http::field::content_type, type);
  r.set(http::field::server, "faba");
  r.set(http::field::cache_control, keep ? "private, max-age=3600" : "no-store");
  r.set("Content-Security-Policy", report ? kReportPolicy : kPolicy);
  r.set("X-Content-Type-Options", "nosniff");
  r.set("Referrer-Policy", "no-referrer");
  r.set("Cross-Origin-Resource-Policy", "same-origin");
  r.set("Cross-Origin-Opener-Policy", "same-origin");
}

}  // namespace

struct WebServer::Impl {
  std::filesystem::path uploads;
  const Access* access = nullptr;
  WebHandlers handlers;
  std::atomic<std::size_t> coming = 0;       // uploads
  std::atomic<std::uint64_t> expected = 0;   // bytes of these uploads
  std::atomic<std::size_t> connections = 0;  // atomic: the last reference may be released by a worker thread
  std::uint64_t next_page = 1;
  // Declared last: pending connections use the members above until io is destroyed.
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::thread_pool workers{2};

  void accept();
};

/// The file of an upload, which is removed at the end of the request.
struct Upload {
  Upload(WebServer::Impl& s, std::uint64_t bytes, const std::string& name)
      : server(s), length(bytes), file(s.uploads / name) {
    ++server.coming;
    server.expected += length;
  }
  ~Upload() {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    server.expected -= length;
    --server.coming;
  }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;
  /// Until the mean rate is below the minimum.
  std::chrono::nanoseconds time_left(std::uint64_t received) const {
    const auto needed = std::chrono::seconds(std::int64_t(received / kLeastRate));
    return began + kRequestTimeout + needed - std::chrono::steady_clock::now();
  }

  WebServer::Impl& server;
  std::uint64_t length;  ///< bytes
  std::filesystem::path file;
  std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
};

/// A connection of a client: a sequence of requests, or the handshake of a WebSocket.
class Connection final : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket s, WebServer::Impl& server) : server_(server), stream_(std::move(s)) {
    ++server_.connections;
    counted_ = {nullptr, [&n = server_.connections](void*) { --n; }};
  }

  void read() {
    head_.emplace();
    head_->header_limit(kMostHeader);
    head_->body_limit(
        std::numeric_limits<std::uint64_t>::max());  // the limit depends on the path, which is unknown here
    stream_.expires_after(kRequestTimeout);
    http::async_read_header(
        stream_, buffer_, *head_, [self = shared_from_this()](beast::error_code ec, std::size_t) {
          if (!ec) return self->judge();
          if (ec == http::error::header_limit) return self->refuse(431, "request header is too large");
          const bool disconnected = ec == http::error::end_of_stream ||
                                    ec.category() != http::make_error_code(http::error::bad_value).category();
          if (disconnected) return self->close();
          self->refuse(400, "invalid request: " + ec.message());
        });
  }

 private:
  void judge() {
    const Header& h = head_->get().base();
    target_ = parse_target({h.target().data(), h.target().size()});
    const Access::Verdict verdict = server_.access->judge(credentials_of(h, target_));
    if (verdict.status != 200) return refuse(verdict.status, verdict.why);
    if (!target_) return refuse(400, "invalid request: malformed target");
    if (beast::iequals(h[http::field::upgrade], "websocket")) return open_socket();
    const std::string method(h.method_string());
    if (method != "GET" && method != "HEAD" && method != "POST" && method != "DELETE")
      return refuse(405, "method not allowed; use GET, HEAD, POST or DELETE");
    // Replaces the token by the cookie, so that the token does not remain in the address bar.
    if (verdict.by_token && target_->path == "/" && method == "GET") return exchange();
    if (target_->path == "/api/upload" || target_->path.starts_with("/api/upload/"))
      return method == "POST" ? take_file() : refuse(405, "method not allowed; use POST");
    auto parser = std::make_shared<http::request_parser<http::string_body>>(std::move(*head_));
    parser->body_limit(WebServer::kMostBody);
    if (parser->content_length() && *parser->content_length() > WebServer::kMostBody)
      return refuse(413, "request body is too large");
    http::async_read(stream_, buffer_, *parser,
                     [self = shared_from_this(), parser](beast::error_code ec, std::size_t) {
                       if (ec == http::error::body_limit)
                         return self->refuse(413, "request body is too large");
                       if (ec) return self->close();
                       self->answer(std::move(parser->get().body()), {}, parser->get().base());
                     });
  }

  void open_socket() {
    const auto request = head_->get();
    if (target_->path != "/ws") return refuse(404, "not found; the WebSocket is at /ws");
    if (!beast::websocket::is_upgrade(request)) return refuse(400, "invalid WebSocket request");
    auto offered = http::token_list(request[http::field::sec_websocket_protocol]);
    if (!offered.exists(kPageProtocol))
      return refuse(
          400, fmt::format("unsupported WebSocket protocol; it must be {}; reload the page", kPageProtocol));
    stream_.expires_never();
    open_page_socket(stream_.release_socket(), request, server_.handlers, server_.next_page++, counted_);
  }

  void exchange() {
    auto r = std::make_shared<http::response<http::string_body>>(http::status::see_other, 11);
    set_headers(*r, "text/plain; charset=utf-8", false);
    r->set(http::field::set_cookie, server_.access->cookie());
    r->set(http::field::location, "/");
    send(r);
  }

  void take_file() {
    static std::atomic<unsigned> number{0};
    auto parser = std::make_shared<http::request_parser<http::file_body>>(std::move(*head_));
    parser->body_limit(WebServer::kMostUpload);
    const auto length = parser->content_length();
    if (!length) return refuse(411, "the length of the upload is missing; send Content-Length");
    if (*length > WebServer::kMostUpload) return refuse(413, "request body is too large");
    if (server_.coming >= WebServer::kMostUploads)
      return refuse(429, fmt::format("{} uploads are in progress, the maximum; try again when one has ended",
                                     WebServer::kMostUploads));
    std::error_code unknown;
    const auto space = std::filesystem::space(server_.uploads, unknown);
    // Uploads in progress may still need all the space for which they were accepted.
    if (!unknown && space.available < kSpareDisk + server_.expected + *length)
      return refuse(507, fmt::format("the upload needs {:.1f} MB, but only {:.1f} MB are free for temporary "
                                     "files; delete files or set TMPDIR to a folder on another disk",
                                     double(*length) / 1e6, double(space.available) / 1e6));
    auto upload =
        std::make_shared<Upload>(server_, *length, fmt::format("upload-{}-{}.part", ::getpid(), ++number));
    beast::error_code ec;
    parser->get().body().open(upload->file.c_str(), beast::file_mode::write, ec);
    if (ec) return refuse(500, "cannot store the upload: " + ec.message());
    take_more(parser, upload);
  }
  // Reads in parts, so that the timeout restarts with every part.
  void take_more(const std::shared_ptr<http::request_parser<http::file_body>>& parser,
                 const std::shared_ptr<Upload>& upload) {
    if (parser->is_done()) return answer({}, upload, parser->get().base());  // empty body
    const auto left = upload->time_left(*parser->content_length() - *parser->content_length_remaining());
    if (left <= std::chrono::seconds(0)) return refuse(408, "the upload is too slow");
    stream_.expires_after(std::min<std::chrono::nanoseconds>(kRequestTimeout, left));
    http::async_read_some(stream_, buffer_, *parser,
                          [self = shared_from_this(), parser, upload](beast::error_code ec, std::size_t) {
                            if (!ec && !parser->is_done()) return self->take_more(parser, upload);
                            parser->get().body().close();
                            if (!ec) return self->answer({}, upload, parser->get().base());
                            if (ec == http::error::body_limit)
                              return self->refuse(413, "request body is too large");
                            self->close();
                          });
  }

  void answer(std::string body, const std::shared_ptr<Upload>& upload, const Header& header) {
    auto request = std::make_shared<WebRequest>();
    request->method = std::string(header.method_string());
    request->path = target_->path;
    request->query = target_->query;
    request->query.erase("token");
    request->body = std::move(body);
    if (upload) request->upload = upload->file;
    const std::string range(header[http::field::range]);
    stream_.expires_never();  // no timeout while the handler runs
    asio::post(server_.workers, [self = shared_from_this(), request, range, kept = upload]() mutable {
      auto response = std::make_shared<WebResponse>(self->server_.handlers.answer(*request));
      kept.reset();  // removes the file
      asio::post(self->stream_.get_executor(), [self, request, response, range] {
        self->deliver(*response, range, request->method == "HEAD");
      });
    });
  }

  void deliver(const WebResponse& w, const std::string& range, bool head_only) {
    if (!w.file.empty()) return deliver_file(w, range, head_only);
    auto r = std::make_shared<http::response<http::string_body>>(http::status(unsigned(w.status)), 11);
    set_headers(*r, w.type, w.keep, w.report);
    if (head_only)
      r->content_length(w.body.size());
    else
      r->body() = w.body;
    send(r, head_only);
  }

  void deliver_file(const WebResponse& w, const std::string& range, bool head_only) {
    beast::error_code ec;
    http::file_body::value_type file;
    try {
      const OpenedPath opened(w.file);
      if (!opened.is_regular_file()) return refuse(404, "is not a file");
      file.open(opened.path().c_str(), beast::file_mode::scan, ec);
    } catch (const Error&) {
      return refuse(404, "file not found");
    }
    if (ec) return refuse(404, "cannot read the file");
    const auto part = parse_range(range, file.size());
    if (!part) {
      auto r = std::make_shared<http::response<http::file_body>>(
          std::piecewise_construct, std::make_tuple(std::move(file)), std::make_tuple(http::status::ok, 11));
      set_headers(*r, w.type, w.keep, w.report);
      r->set(http::field::accept_ranges, "bytes");
      return send(r, head_only);
    }
    const std::uint64_t end = std::min(part->end, part->begin + kMostOfRange);
    auto r = std::make_shared<http::response<http::string_body>>(http::status::partial_content, 11);
    set_headers(*r, w.type, w.keep, w.report);
    r->set(http::field::accept_ranges, "bytes");
    r->set(http::field::content_range, fmt::format("bytes {}-{}/{}", part->begin, end - 1, file.size()));
    r->body().resize(std::size_t(end - part->begin));
    file.file().seek(part->begin, ec);
    std::size_t read = 0;
    while (!ec && read < r->body().size()) {
      const std::size_t n = file.file().read(r->body().data() + read, r->body().size() - read, ec);
      if (n == 0) break;
      read += n;
    }
    if (ec || read < r->body().size()) return refuse(404, "cannot read the file");
    send(r, head_only);
  }

  void refuse(int status, const std::string& why) {
    auto r = std::make_shared<http::response<http::string_body>>(http::status(unsigned(status)), 11);
    set_headers(*r, "text/plain; charset=utf-8", false);
    r->body() = "faba: " + why + "\n";
    r->keep_alive(false);  // the rest of the request is not read
    send(r);
  }

  template <class Response>
  void send(const std::shared_ptr<Response>& r, bool head_only = false) {
    if (!head_only) r->prepare_payload();
    const bool again = !r->need_eof();
    stream_.expires_after(kRequestTimeout);
    const auto sent = [self = shared_from_this(), r, again](beast::error_code ec, std::size_t) {
      if (ec || !again) return self->close();
      self->read();
    };
    if (!head_only) return http::async_write(stream_, *r, sent);
    using Body = typename Response::body_type;
    auto serializer = std::make_shared<http::response_serializer<Body>>(*r);
    http::async_write_header(stream_, *serializer,
                             [serializer, sent](beast::error_code ec, std::size_t n) { sent(ec, n); });
  }

  void close() {
    beast::error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  WebServer::Impl& server_;
  std::shared_ptr<void> counted_;  ///< released with the connection, or with its WebSocket
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kMostHeader + (64u << 10)};
  std::optional<http::request_parser<http::empty_body>> head_;
  std::optional<WebTarget> target_;
};

void WebServer::Impl::accept() {
  acceptor.async_accept([this](beast::error_code ec, tcp::socket s) {
    if (ec == asio::error::operation_aborted) return;
    // Connections above the limit are closed at once.
    if (!ec && connections < kMostConnections) {
      beast::error_code ignored;
      s.set_option(tcp::no_delay(true), ignored);
      std::make_shared<Connection>(std::move(s), *this)->read();
    }
    accept();
  });
}

WebServer::WebServer(unsigned short port, std::filesystem::path uploads) : impl_(std::make_unique<Impl>()) {
  impl_->uploads = std::move(uploads);
  const tcp::endpoint here(asio::ip::address_v4::loopback(), port);
  beast::error_code ec;
  impl_->acceptor.open(here.protocol(), ec);
  if (!ec) impl_->acceptor.set_option(tcp::acceptor::reuse_address(true), ec);
  if (!ec) impl_->acceptor.bind(here, ec);
  if (!ec) impl_->acceptor.listen(asio::socket_base::max_listen_connections, ec);
  if (ec)
    throw Error(Errc::usage, fmt::format("--port {}", port),
                fmt::format("cannot listen on this port: {}; choose another port, or 0 for any free port",
                            ec.message()));
}

WebServer::~WebServer() { impl_->workers.join(); }

unsigned short WebServer::port() const { return impl_->acceptor.local_endpoint().port(); }

void WebServer::run(const Access& access, WebHandlers handlers) {
  impl_->access = &access;
  impl_->handlers = std::move(handlers);
  impl_->accept();
  impl_->io.run();
  impl_->workers.join();
}

void WebServer::stop() { impl_->io.stop(); }

}  // namespace faba
