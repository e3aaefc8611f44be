// SPDX-License-Identifier: Apache-2.0
#include "viewer/server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <utility>  // before Asio 1.18, which uses std::exchange without including it

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <set>
#include <stop_token>

#include "kontur/base/error.h"
#include "viewer/access.h"
#include "viewer/http_api.h"

// The one file that includes Boost.Beast, which is slow to compile. All of its objects live on one network thread; what
// takes time runs on thread pools and posts its result back.

namespace kontur::viewer {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLargestHeader = 8 << 10;
constexpr std::size_t kLargestMessage = 4 << 20;
/// Behind the message that is being sent, which may be of any size: a page that takes less of what it is told is cut off.
constexpr std::size_t kMostWaitingBytes = 64 << 20;
constexpr std::size_t kBytesPerSecond = 1 << 20;  ///< least speed of long bodies
constexpr std::size_t kMostDrained = 1 << 20;
constexpr int kWorkers = 4;
constexpr int kMostImports = 2;  ///< at a time: each may be large
constexpr const char* kSocket = "/api/socket";
constexpr const char* kImports = "/api/import/";

/// Programs that kontur starts (a browser, the reader of an import) must not keep the port and the connections open.
void keep_to_this_process(int descriptor) { fcntl(descriptor, F_SETFD, FD_CLOEXEC); }

std::string text(beast::string_view view) { return {view.data(), view.size()}; }

class PageSocket;
class Connection;

}  // namespace

/// What all connections share.
struct ServerCore {
    ServerCore(Workspace& its_workspace, const ServerOptions& its_options)
        : workspace(its_workspace),
          api(its_workspace),
          options(its_options),
          last_use(Clock::now()),
          acceptor(io),
          clock(io),
          last_words(io) {}

    Workspace& workspace;
    HttpApi api;
    ServerOptions options;
    Access access;
    std::set<PageSocket*> sockets;
    std::set<Connection*> requests;  ///< the connections over which requests come
    PageId last_page = 0;
    int connections = 0, imports = 0;
    Clock::time_point last_use;
    std::stop_source ending;  ///< of all that is worked on
    asio::io_context io{1};   ///< destroyed before what the connections refer to in their destructors
    tcp::acceptor acceptor;
    asio::steady_timer clock, last_words;
    asio::thread_pool calls{1};        ///< messages of the pages, in order
    asio::thread_pool work{kWorkers};  ///< slices, meshes, files

    void accept();
    bool make_room();
    void tick();
    void broadcast(const std::string& message);
    void stop();
};

namespace {

/// Counts something for as long as it lives.
class Slot {
public:
    explicit Slot(int& count) : count_(&count) { ++count; }
    Slot(Slot&& other) noexcept : count_(std::exchange(other.count_, nullptr)) {}
    Slot& operator=(Slot&&) = delete;
    ~Slot() {
        if (count_) --*count_;
    }

private:
    int* count_;
};

// What holds a socket or connection on a pool's thread hands it back to `io` by moving it: whoever lets go last destroys it,
// and that changes what only the thread of `io` may touch.

/// One open page: messages in, one at a time, and replies and events out.
class PageSocket : public std::enable_shared_from_this<PageSocket> {
public:
    PageSocket(ServerCore& core, Slot slot, tcp::socket socket)
        : core_(core), slot_(std::move(slot)), stream_(std::move(socket)), buffer_(kLargestMessage), id_(++core.last_page) {}
    ~PageSocket() { core_.sockets.erase(this); }

    void accept(const http::request<http::string_body>& request) {
        stream_.set_option(websocket::stream_base::timeout{std::chrono::seconds(10), std::chrono::seconds(60), true});
        stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
            response.set(http::field::sec_websocket_protocol, "kontur");
            response.set(http::field::server, "kontur");
        }));
        stream_.read_message_max(kLargestMessage);
        stream_.auto_fragment(false);
        stream_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
            if (!error) self->greet();
        });
    }

    /// Events wait until the page has been greeted.
    void tell(const std::shared_ptr<const std::string>& message) {
        if (is_greeted_) send(message);
        else held_back_.push_back(message);
    }

private:
    void greet() {
        core_.sockets.insert(this);
        asio::post(core_.calls, [self = shared_from_this()]() mutable {
            ServerCore& core = self->core_;
            std::shared_ptr<const std::string> greeting;
            std::string problem;
            try {
                greeting = std::make_shared<const std::string>(core.workspace.greeting(self->id_));
            } catch (const std::exception& error) {
                problem = error.what();
            }
            asio::post(core.io, [self = std::move(self), greeting, problem] {
                if (!greeting) return self->turn_away(problem);
                self->is_greeted_ = true;
                self->send(greeting);
                for (const auto& message : self->held_back_) self->send(message);
                self->held_back_.clear();
                self->read();
            });
        });
    }

    void turn_away(const std::string& problem) {
        send(std::make_shared<const std::string>(notice_event("error", problem)));
        close(websocket::close_code::internal_error);
    }

    void read() {
        if (is_closing_) return;
        stream_.async_read(buffer_, [self = shared_from_this()](beast::error_code error, std::size_t) {
            self->core_.last_use = Clock::now();
            if (!error) self->take();
            else self->leave();
        });
    }

    /// The next message is read only when this one is answered, so a flood waits in the sender's socket.
    void take() {
        if (is_closing_) return;
        if (!stream_.got_text()) return close(websocket::close_code::unknown_data);
        asio::post(core_.calls, [self = shared_from_this(), message = beast::buffers_to_string(buffer_.data())]() mutable {
            ServerCore& core = self->core_;
            auto reply = std::make_shared<const std::string>(core.workspace.call(message, self->id_));
            asio::post(core.io, [self = std::move(self), reply] {
                self->send(reply);
                self->read();
            });
        });
        buffer_.consume(buffer_.size());
    }

    void send(const std::shared_ptr<const std::string>& message) {
        if (is_closing_) return;
        if (!unsent_.empty()) waiting_bytes_ += message->size();
        if (waiting_bytes_ > kMostWaitingBytes) return cut_off();
        unsent_.push_back(message);
        if (unsent_.size() == 1) write();
    }

    void write() {
        stream_.text(true);
        stream_.async_write(asio::buffer(*unsent_.front()),
                            [self = shared_from_this()](beast::error_code error, std::size_t) {
                                if (error) return self->cut_off();
                                self->unsent_.pop_front();
                                if (self->unsent_.empty()) return;
                                self->waiting_bytes_ -= self->unsent_.front()->size();
                                self->write();
                            });
    }

    void close(websocket::close_code reason) {
        is_closing_ = true;
        leave();
        stream_.async_close(reason, [self = shared_from_this()](beast::error_code) {});
    }

    void cut_off() {
        is_closing_ = true;
        leave();
        beast::error_code ignored;
        stream_.next_layer().socket().close(ignored);
    }

    /// After what it has asked for so far.
    void leave() {
        if (core_.sockets.erase(this) == 0) return;
        asio::post(core_.calls, [&core = core_, id = id_] { core.workspace.left(id); });
    }

    ServerCore& core_;
    Slot slot_;
    websocket::stream<beast::tcp_stream> stream_;
    beast::flat_buffer buffer_;
    const PageId id_;
    bool is_greeted_ = false, is_closing_ = false;
    std::vector<std::shared_ptr<const std::string>> held_back_;
    std::deque<std::shared_ptr<const std::string>> unsent_;
    std::size_t waiting_bytes_ = 0;
};

/// One HTTP connection: a request at a time; becomes a PageSocket by an upgrade.
class Connection : public std::enable_shared_from_this<Connection> {
public:
    Connection(ServerCore& core, tcp::socket socket)
        : core_(core), slot_(core.connections), stream_(std::move(socket)), buffer_(128 << 10) {
        core_.requests.insert(this);
    }
    ~Connection() { core_.requests.erase(this); }

    /// Which one goes first where there is no room for a new one: those that have never shown the token, then those between
    /// two requests, which a browser opens again; each by how long nothing has come. Others stay.
    bool may_go() const { return !is_known_ || is_waiting_; }
    bool goes_before(const Connection& other) const {
        return std::pair(is_known_, last_sign_) < std::pair(other.is_known_, other.last_sign_);
    }

    void drop() {
        slot_.reset();
        core_.requests.erase(this);
        stream_.close();
    }

    void wait_for_request(std::chrono::seconds patience) {
        is_waiting_ = true;
        parser_.emplace();
        parser_->header_limit(kLargestHeader);
        // Checked again, by target, once the header is known; the parser would refuse imports by its own limit.
        parser_->body_limit(HttpApi::body_limit(kImports));
        stream_.expires_after(patience);
        http::async_read_header(stream_, buffer_, *parser_,
                                [self = shared_from_this()](beast::error_code error, std::size_t) {
                                    self->is_waiting_ = false;
                                    self->last_sign_ = self->core_.last_use = Clock::now();
                                    if (error) self->refuse_header(error);
                                    else self->check_header();
                                });
    }

private:
    using Request = http::request<http::string_body>;

    static std::vector<std::string> values(const Request& request, http::field field) {
        std::vector<std::string> found;
        const auto range = request.equal_range(field);
        for (auto it = range.first; it != range.second; ++it) found.push_back(text(it->value()));
        return found;
    }

    static RequestHead head_of(const Request& request) {
        return {text(request.method_string()),
                parse_target(text(request.target())),
                values(request, http::field::host),
                values(request, http::field::origin),
                values(request, http::field::authorization),
                values(request, http::field::sec_websocket_protocol),
                websocket::is_upgrade(request)};
    }

    void refuse_header(beast::error_code error) {
        if (error == http::error::header_limit || error == http::error::buffer_overflow)
            return finish_with(error_reply(431, "too_large", "the request's header is larger than 8 KiB"));
        if (error == http::error::body_limit)
            return finish_with(error_reply(413, "too_large", "the request's body is too large"));
        const bool is_malformed = error.category() == http::make_error_code(http::error::bad_method).category();
        if (is_malformed && error != http::error::end_of_stream && error != http::error::partial_message)
            return finish_with(error_reply(400, "invalid_input", "this is no HTTP request"));
        end();
    }

    void check_header() {
        const Request& request = parser_->get();
        const RequestHead head = head_of(request);
        if (const auto refused = refusal(head, core_.access))
            return finish_with(error_reply(refused->status, refused->kind, refused->message));
        is_known_ = is_known_ || shows_token(head, core_.access);
        host_ = head.host.front();
        opening_.reset();
        if (const auto named = request.find("Kontur-Opening"); named != request.end()) opening_ = text(named->value());
        if (!head.target) return finish_with(error_reply(400, "invalid_input", "the address is malformed"));
        target_ = *head.target;
        const bool is_socket = target_.path == kSocket;
        if (head.is_upgrade != is_socket)
            return finish_with(error_reply(404, "not_found", "there is nothing at this address"));
        if (is_socket) return upgrade();

        const std::uint64_t limit = HttpApi::body_limit(target_.path), length = parser_->content_length().value_or(0);
        if (length > limit)
            return finish_with(error_reply(413, "too_large",
                                           fmt::format("the request's body has {} bytes; the limit is {}", length, limit)));
        parser_->body_limit(limit);
        if (target_.path.starts_with(kImports)) {
            if (core_.imports >= kMostImports)
                return finish_with(error_reply(413, "too_large", "other files are being imported; try again after them"));
            import_.emplace(core_.imports);
        }
        stream_.expires_after(
            std::chrono::seconds(core_.options.request_timeout_s + static_cast<long>(length / kBytesPerSecond)));
        http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
            if (error) self->refuse_header(error);
            else self->work();
        });
    }

    void upgrade() {
        stream_.expires_never();
        core_.requests.erase(this);
        const auto socket = std::make_shared<PageSocket>(core_, std::move(*slot_), stream_.release_socket());
        socket->accept(parser_->get());
    }

    void work() {
        Request request = parser_->release();
        keep_alive_ = request.keep_alive();
        auto make = core_.api.prepare({text(request.method_string()), target_, std::move(request.body()), opening_});
        stop_ = std::stop_source();
        watch();
        asio::post(core_.work, [self = shared_from_this(), make = std::move(make), stop = stop_]() mutable {
            ServerCore& core = self->core_;
            const std::stop_callback end(core.ending.get_token(), [&] { stop.request_stop(); });
            auto reply = std::make_shared<HttpReply>(make(stop.get_token()));
            asio::post(core.io, [self = std::move(self), reply] {
                beast::error_code ignored;
                self->stream_.socket().cancel(ignored);  // the watch
                self->reply(std::move(*reply));
            });
        });
    }

    /// Nothing is worked on for a client that has gone: that is how a page cancels. What it sends already, ahead of our
    /// reply, stays in the socket.
    void watch() {
        stream_.socket().async_wait(tcp::socket::wait_read, [self = shared_from_this()](beast::error_code error) {
            char byte = 0;
            if (error) return;
            if (recv(self->stream_.socket().native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0)
                self->stop_.request_stop();
        });
    }

    void finish_with(HttpReply refusal) {
        keep_alive_ = false;
        reply(std::move(refusal));
    }

    void reply(HttpReply reply) {
        import_.reset();
        last_sign_ = core_.last_use = Clock::now();
        response_ = {};
        response_.version(11);
        response_.result(static_cast<unsigned>(reply.status));
        response_.set(http::field::server, "kontur");
        response_.set(http::field::content_type, reply.content_type);
        for (const auto& [key, value] : security_headers(host_)) response_.set(key, value);
        for (const auto& [key, value] : reply.headers) response_.set(key, value);
        response_.keep_alive(keep_alive_);
        const std::size_t size = reply.body.size();
        response_.body() = std::move(reply.body);
        response_.prepare_payload();
        stream_.expires_after(
            std::chrono::seconds(core_.options.reply_timeout_s + static_cast<long>(size / kBytesPerSecond)));
        http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code error, std::size_t) {
            if (error) return;
            if (self->keep_alive_) self->wait_for_request(std::chrono::seconds(self->core_.options.keep_alive_s));
            else self->end();
        });
    }

    /// Closes without a reset, which would take the reply from a client that is still sending.
    void end() {
        beast::error_code ignored;
        stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
        stream_.expires_after(std::chrono::seconds(2));
        drain();
    }

    void drain() {
        buffer_.consume(buffer_.size());
        stream_.async_read_some(buffer_.prepare(64 << 10),
                                [self = shared_from_this()](beast::error_code error, std::size_t count) {
                                    self->drained_ += count;
                                    if (!error && self->drained_ < kMostDrained) self->drain();
                                });
    }

    ServerCore& core_;
    std::optional<Slot> slot_;  ///< until it is dropped
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_;
    bool is_known_ = false;    ///< by the token, which only the user's own programs have
    bool is_waiting_ = false;  ///< for a request's header
    Clock::time_point last_sign_ = Clock::now();
    std::optional<http::request_parser<http::string_body>> parser_;
    http::response<http::string_body> response_;
    std::optional<Slot> import_;
    std::stop_source stop_{std::nostopstate};  ///< of what is worked on
    std::string host_ = "127.0.0.1";
    Target target_;  ///< of the request
    std::optional<std::string> opening_;
    bool keep_alive_ = false;
    std::size_t drained_ = 0;
};

}  // namespace

void ServerCore::accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
        if (!acceptor.is_open()) return;
        if (!error && make_room()) {
            beast::error_code ignored;
            socket.set_option(tcp::no_delay(true), ignored);
            keep_to_this_process(socket.native_handle());
            std::make_shared<Connection>(*this, std::move(socket))
                ->wait_for_request(std::chrono::seconds(options.request_timeout_s));
        }
        accept();
    });
}

/// Whoever opens connections and says nothing must not shut the page out.
bool ServerCore::make_room() {
    if (connections < options.most_connections) return true;
    Connection* first = nullptr;
    for (Connection* connection : requests)
        if (connection->may_go() && (!first || connection->goes_before(*first))) first = connection;
    if (!first) return false;
    first->drop();
    return true;
}

void ServerCore::tick() {
    clock.expires_after(std::chrono::milliseconds(250));
    clock.async_wait([this](beast::error_code error) {
        if (error) return;
        const bool is_reading = !workspace.wait_for(std::chrono::milliseconds(0));
        if (!sockets.empty() || is_reading) last_use = Clock::now();
        if (options.idle_timeout_s > 0 && Clock::now() - last_use > std::chrono::seconds(options.idle_timeout_s)) stop();
        else tick();
    });
}

void ServerCore::broadcast(const std::string& message) {
    asio::post(io, [this, shared = std::make_shared<const std::string>(message)] {
        const std::set<PageSocket*> now = sockets;  // telling one may remove it
        for (PageSocket* socket : now) socket->tell(shared);
    });
}

void ServerCore::stop() {
    beast::error_code ignored;
    acceptor.close(ignored);
    io.stop();
}

Server::Server(Workspace& workspace, const ServerOptions& options)
    : core_(std::make_unique<ServerCore>(workspace, options)) {
    core_->access.token = options.token.empty() ? random_token() : options.token;
    const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), options.port);
    beast::error_code error;
    core_->acceptor.open(endpoint.protocol(), error);
    if (!error) core_->acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) core_->acceptor.bind(endpoint, error);
    if (!error) core_->acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error) throw Error(ErrorKind::io, fmt::format("cannot listen on 127.0.0.1:{}: {}", options.port, error.message()));
    keep_to_this_process(core_->acceptor.native_handle());
    core_->access.port = core_->acceptor.local_endpoint().port();
    workspace.on_event([core = core_.get()](const std::string& message) { core->broadcast(message); });
}

Server::~Server() {
    core_->workspace.on_event({});
    core_->ending.request_stop();
    for (asio::thread_pool* pool : {&core_->calls, &core_->work}) {
        pool->stop();  // what waits is dropped, what runs is finished
        pool->join();
    }
}

std::string Server::address() const {
    return fmt::format("http://127.0.0.1:{}/#{}", core_->access.port, core_->access.token);
}

void Server::run() {
    core_->accept();
    core_->tick();
    core_->io.run();
}

void Server::stop_soon() {
    asio::post(core_->io, [core = core_.get()] {
        core->last_words.expires_after(std::chrono::seconds(1));
        core->last_words.async_wait([core](beast::error_code) { core->stop(); });
    });
}

void Server::stop() {
    asio::post(core_->io, [core = core_.get()] { core->stop(); });
}

}  // namespace kontur::viewer
