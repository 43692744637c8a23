#include "server/page_socket.h"

#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>

namespace faba {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;

namespace {

constexpr auto kHandshake = std::chrono::seconds(30);
constexpr auto kIdle = std::chrono::seconds(20);           // timeout of pings
constexpr std::size_t kMostUnread = 8u << 20;              // maximum size of unsent text
constexpr double kMessagesPerSecond = 200, kBurst = 1000;  // limit per page; dragging sends sixty

class Socket final : public PageSocket, public std::enable_shared_from_this<Socket> {
 public:
  Socket(tcp::socket s, const WebHandlers& handlers, std::uint64_t id, std::shared_ptr<void> counted)
      : handlers_(handlers), id_(id), counted_(std::move(counted)), stream_(std::move(s)) {}

  void open(const http::request<http::empty_body>& request) {
    websocket::stream_base::timeout t{};
    t.handshake_timeout = kHandshake;
    t.idle_timeout = kIdle;
    t.keep_alive_pings = true;
    stream_.set_option(t);
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& r) {
      r.set(http::field::sec_websocket_protocol, kPageProtocol);
      r.set(http::field::server, "faba");
    }));
    stream_.read_message_max(kMostPageMessage);
    stream_.auto_fragment(false);
    stream_.write_buffer_bytes(64u << 10);
    stream_.async_accept(request, [self = shared_from_this()](beast::error_code ec) {
      if (ec) return;
      self->open_ = true;
      self->handlers_.opened(self);
      self->read();
    });
  }

  std::uint64_t id() const override { return id_; }
  void send_text(std::string text) override {
    asio::post(stream_.get_executor(), [self = shared_from_this(),
                                        t = std::make_shared<const std::string>(std::move(text))]() mutable {
      if (!self->open_) return;
      self->unread_ += t->size();
      self->texts_.push_back(std::move(t));
      if (self->unread_ > kMostUnread) return self->close();
      self->write();
    });
  }
  void send_frame(std::shared_ptr<const std::string> bytes) override {
    asio::post(stream_.get_executor(), [self = shared_from_this(), b = std::move(bytes)]() mutable {
      if (!self->open_) return;
      self->frame_ = std::move(b);
      self->write();
    });
  }

 private:
  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code ec, std::size_t) {
      if (ec) return self->close();
      if (!self->below_rate_limit()) return self->close();
      if (self->stream_.got_text()) {
        const auto data = self->buffer_.cdata();
        self->handlers_.received(self, {static_cast<const char*>(data.data()), data.size()});
      }
      self->buffer_.consume(self->buffer_.size());
      if (self->open_) self->read();
    });
  }
  bool below_rate_limit() {
    const auto now = std::chrono::steady_clock::now();
    tokens_ += std::chrono::duration<double>(now - last_message_).count() * kMessagesPerSecond;
    tokens_ = std::min(tokens_, kBurst) - 1;
    last_message_ = now;
    return tokens_ > 0;
  }
  void write() {
    if (writing_ || !open_) return;
    if (!texts_.empty()) {
      sent_ = std::move(texts_.front());
      texts_.pop_front();
      unread_ -= sent_->size();
      stream_.text(true);
    } else if (frame_) {
      sent_ = std::move(frame_);
      frame_.reset();
      stream_.binary(true);
    } else {
      return;
    }
    writing_ = true;
    stream_.async_write(asio::buffer(*sent_), [self = shared_from_this()](beast::error_code ec, std::size_t) {
      self->writing_ = false;
      if (ec) return self->close();
      self->write();
    });
  }
  void close() {
    if (!open_) return;
    open_ = false;
    beast::error_code ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
    handlers_.closed(shared_from_this());
  }

  const WebHandlers& handlers_;
  std::uint64_t id_;
  std::shared_ptr<void> counted_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  bool open_ = false, writing_ = false;
  std::deque<std::shared_ptr<const std::string>> texts_;
  std::size_t unread_ = 0;
  std::shared_ptr<const std::string> frame_, sent_;
  double tokens_ = kBurst;
  std::chrono::steady_clock::time_point last_message_ = std::chrono::steady_clock::now();
};

}  // namespace

void open_page_socket(tcp::socket connection, const http::request<http::empty_body>& request,
                      const WebHandlers& handlers, std::uint64_t id, std::shared_ptr<void> counted) {
  std::make_shared<Socket>(std::move(connection), handlers, id, std::move(counted))->open(request);
}

}  // namespace faba
