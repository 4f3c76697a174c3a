#include "serve/web/web_server.h"

#include <fmt/format.h>
#include <libwebsockets.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "serve/session/client.h"
#include "serve/stream/streamer.h"
#include "serve/web/access.h"
#include "serve/web/page_files.h"
#include "serve/web/token.h"
#include "serve/web/uploads.h"

namespace limpid::serve {
namespace {

constexpr unsigned maxConnections = 1200;  ///< open sockets, most of which say nothing
constexpr size_t maxClients = 32;          ///< WebSockets
constexpr size_t maxUploads = 2;           ///< at the same time
constexpr int maxHeaderBytes = 1024;
constexpr size_t chunkBytes = 65536;
constexpr int chunkSeconds = 30;  ///< for a client to take one
constexpr lws_usec_t tick = LWS_USEC_PER_SEC / 20;

/// No script, style or connection but this server's own; no other page may frame it.
constexpr const char* policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src "
    "'self'; "
    "worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

struct Extra {
    const char *name, *value;
};
constexpr std::array<Extra, 6> securityHeaders{{{"content-security-policy:", policy},
                                                {"x-content-type-options:", "nosniff"},
                                                {"referrer-policy:", "no-referrer"},
                                                {"cross-origin-opener-policy:", "same-origin"},
                                                {"cross-origin-resource-policy:", "same-origin"},
                                                {"cache-control:", "no-store"}}};

std::string headerOf(lws* wsi, lws_token_indexes which) {
    const int length = lws_hdr_total_length(wsi, which);
    if (length <= 0 || length > maxHeaderBytes) return {};
    std::string text(static_cast<size_t>(length) + 1, '\0');
    const int copied = lws_hdr_copy(wsi, text.data(), length + 1, which);
    text.resize(static_cast<size_t>(std::max(copied, 0)));
    return text;
}

/// A parameter of the address.
std::string argumentOf(lws* wsi, const char* name) {
    std::array<char, 256> buffer{};
    const char* const value = lws_get_urlarg_by_name(wsi, name, buffer.data(), buffer.size() - 1);
    return value ? std::string(value) : std::string();
}

/// Many systems start programs with a limit of 1024 open files, of which each connection is one.
void allowManyFiles() {
    rlimit limit{};
    const rlim_t wanted = maxConnections + 500;
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return;
    limit.rlim_cur = std::min(limit.rlim_max, wanted);
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

Bytes bytesOf(std::string_view text) {
    const auto* const begin = reinterpret_cast<const std::byte*>(text.data());
    return std::make_shared<const std::vector<std::byte>>(begin, begin + text.size());
}

struct DestroyContext {
    void operator()(lws_context* context) const { lws_context_destroy(context); }
};

/// Runs a callback of libwebsockets. Its functions are C, which no exception may pass: one is logged, and the
/// connection is closed. At its head or its end a request gets an answer first; within its body, and where a
/// WebSocket is asked for, it gets none. What cannot even be logged ends the program.
template <typename Action>
int guarded(lws* wsi, lws_callback_reasons reason, const Action& action) noexcept {
    unsigned status = HTTP_STATUS_INTERNAL_SERVER_ERROR;
    try {
        return action();
    } catch (const StorageError& fault) {
        constexpr unsigned insufficientStorage = 507;
        status = insufficientStorage;
        log::error("{}", fault.what());
    } catch (const std::exception& fault) {
        log::error("a connection was closed: {}", fault.what());
    } catch (...) {
        log::error("a connection was closed after an unknown fault");
    }
    if (reason == LWS_CALLBACK_EVENT_WAIT_CANCELLED) return 0;  // belongs to no connection
    if (reason == LWS_CALLBACK_HTTP || reason == LWS_CALLBACK_HTTP_BODY_COMPLETION)
        lws_return_http_status(wsi, status, nullptr);
    return -1;
}

/// An answer that is being sent.
struct Answer {
    Bytes body;
    size_t sent = 0;
};

}  // namespace

struct WebServer::Impl {
    studio::Session& session;
    ServeSettings settings;
    const SceneFiles& files;
    std::string token;
    bool tls;
    std::map<lws*, Answer> answers;
    std::map<lws*, Clock::time_point> waiting;  ///< for /picture.png, until then
    Uploads uploads;
    std::map<lws*, std::unique_ptr<Upload>> uploading;
    uint64_t lastOpened = 0;  ///< number of the message that opens the last upload
    std::mutex stillMutex;
    Bytes still;  ///< for all that wait
    bool stillAsked = false;
    std::array<lws_protocols, 3> protocols{};
    lws_retry_bo_t idle{};
    uint64_t listener = 0;
    // Destroyed in the reverse order: closing the connections removes clients, which use the streamer.
    std::unique_ptr<Streamer> streamer;
    std::map<lws*, std::unique_ptr<Client>> clients;
    std::unique_ptr<lws_context, DestroyContext> context;

    Impl(studio::Session& s, const ServeSettings& with, const SceneFiles& f, std::string t)
        : session(s),
          settings(with),
          files(f),
          token(std::move(t)),
          tls(!with.certificate.empty()),
          uploads(with.uploads) {}
    /// First ends what calls wake() from other threads.
    ~Impl() {
        if (listener != 0) session.removeListener(listener);
        if (streamer) streamer->stop();
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    static Impl& of(lws* wsi) { return *static_cast<Impl*>(lws_context_user(lws_get_context(wsi))); }
    void wake() const { lws_cancel_service(context.get()); }

    bool isAllowed(lws* wsi, bool withOrigin) const {
        const std::string host = headerOf(wsi, WSI_TOKEN_HOST);
        // One that is too long to be read must not count as missing, as that of a program.
        if (withOrigin && lws_hdr_total_length(wsi, WSI_TOKEN_ORIGIN) > maxHeaderBytes) return false;
        return isAllowedHost(host, settings.bind, settings.origins) &&
               (!withOrigin || isAllowedOrigin(headerOf(wsi, WSI_TOKEN_ORIGIN), host, tls, settings.origins));
    }
    bool hasToken(lws* wsi) const { return sameToken(argumentOf(wsi, "token="), token); }

    int refuse(lws* wsi, unsigned status) const;
    int answer(lws* wsi, const char* type, Bytes body, unsigned status = HTTP_STATUS_OK);
    void answerLater(lws* wsi, const char* type, const Bytes& body, unsigned status);
    int sendAnswer(lws* wsi);
    int http(lws* wsi, const std::string& path);
    int confirmUpgrade(lws* wsi);
    int askForStill(lws* wsi);
    int beginUpload(lws* wsi);
    void tidyUploads();
    int receiveUpload(lws* wsi, std::span<const std::byte> bytes);
    int endUpload(lws* wsi);
    int sendToClient(lws* wsi, Client& client);
    void afterWake();
    int handleHttp(lws* wsi, lws_callback_reasons reason, void* in, size_t length);
    int handleSocket(lws* wsi, lws_callback_reasons reason, void* in, size_t length);
    static int onHttp(lws* wsi, lws_callback_reasons reason, void*, void* in, size_t length);
    static int onSocket(lws* wsi, lws_callback_reasons reason, void*, void* in, size_t length);
};

int WebServer::Impl::refuse(lws* wsi, unsigned status) const {
    lws_return_http_status(wsi, status, nullptr);
    return -1;
}

int WebServer::Impl::answer(lws* wsi, const char* type, Bytes body, unsigned status) {
    std::array<unsigned char, LWS_PRE + 2048> buffer{};
    unsigned char *start = buffer.data() + LWS_PRE, *at = start, *end = buffer.data() + buffer.size() - 1;
    if (lws_add_http_common_headers(wsi, status, type, body->size(), &at, end)) return -1;
    for (const Extra& extra : securityHeaders) {
        if (lws_add_http_header_by_name(wsi, reinterpret_cast<const unsigned char*>(extra.name),
                                        reinterpret_cast<const unsigned char*>(extra.value),
                                        static_cast<int>(std::strlen(extra.value)), &at, end))
            return -1;
    }
    if (lws_finalize_write_http_header(wsi, start, &at, end)) return -1;
    answers[wsi] = {std::move(body), 0};
    lws_callback_on_writable(wsi);
    return 0;
}

/// Outside of a callback for this connection, which a fault would end. Throws nothing, so that others get
/// their answers.
void WebServer::Impl::answerLater(lws* wsi, const char* type, const Bytes& body, unsigned status) {
    const auto begin = [&] { return answer(wsi, type, body, status); };
    if (guarded(wsi, LWS_CALLBACK_HTTP_WRITEABLE, begin) != 0)
        lws_set_timeout(wsi, PENDING_TIMEOUT_USER_REASON_BASE, LWS_TO_KILL_ASYNC);
}

int WebServer::Impl::sendAnswer(lws* wsi) {
    const auto found = answers.find(wsi);
    if (found == answers.end()) return 0;
    Answer& answer = found->second;
    const size_t size = std::min(chunkBytes, answer.body->size() - answer.sent);
    const bool last = answer.sent + size == answer.body->size();
    // The library's limit is for the whole answer, which takes minutes where a connection is slow.
    lws_set_timeout(wsi, PENDING_TIMEOUT_HTTP_CONTENT, chunkSeconds);
    std::vector<unsigned char> chunk(LWS_PRE + size);
    if (size > 0) std::memcpy(chunk.data() + LWS_PRE, answer.body->data() + answer.sent, size);
    if (lws_write(wsi, chunk.data() + LWS_PRE, size, last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) <
        static_cast<int>(size))
        return -1;
    answer.sent += size;
    if (!last) {
        lws_callback_on_writable(wsi);
        return 0;
    }
    answers.erase(found);
    return lws_http_transaction_completed(wsi) ? -1 : 0;
}

int WebServer::Impl::http(lws* wsi, const std::string& path) {
    if (!isAllowed(wsi, false)) return refuse(wsi, 421);
    if (path == "/upload" && lws_hdr_total_length(wsi, WSI_TOKEN_POST_URI) > 0) return beginUpload(wsi);
    if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) <= 0) return refuse(wsi, 405);
    if (path == "/picture.png") return hasToken(wsi) ? askForStill(wsi) : refuse(wsi, 403);
    if (path == "/" && !hasToken(wsi)) return refuse(wsi, 403);
    const std::string_view name = path == "/" ? "index.html" : std::string_view(path).substr(1);
    for (const PageFile& file : pageFiles()) {
        if (file.name != name) continue;
        return answer(wsi, std::string(file.type).c_str(), bytesOf(file.text));
    }
    return refuse(wsi, 404);
}

int WebServer::Impl::confirmUpgrade(lws* wsi) {
    const std::string path = headerOf(wsi, WSI_TOKEN_GET_URI);
    if (path != "/session") return refuse(wsi, 404);
    if (!isAllowed(wsi, true) || !hasToken(wsi)) return refuse(wsi, 403);
    if (clients.size() >= maxClients) return refuse(wsi, 503);
    return 0;
}

int WebServer::Impl::askForStill(lws* wsi) {
    waiting[wsi] = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(settings.stillSeconds));
    // The library's own limit would close the connection without an answer.
    lws_set_timeout(wsi, PENDING_TIMEOUT_HTTP_CONTENT, static_cast<int>(settings.stillSeconds) + 10);
    const std::lock_guard lock(stillMutex);
    if (stillAsked) return 0;
    streamer->requestStill([this](Bytes bytes) {
        {
            const std::lock_guard inner(stillMutex);
            still = std::move(bytes);
            stillAsked = false;
        }
        wake();
    });
    stillAsked = true;  // not if that throws: nobody else would ask again
    return 0;
}

int WebServer::Impl::beginUpload(lws* wsi) {
    if (!isAllowed(wsi, true) || !hasToken(wsi) || uploads.maxBytes() == 0) return refuse(wsi, 403);
    const std::string length = headerOf(wsi, WSI_TOKEN_HTTP_CONTENT_LENGTH);
    uint64_t bytes = 0;
    const auto [end, fault] = std::from_chars(length.data(), length.data() + length.size(), bytes);
    if (fault != std::errc() || end != length.data() + length.size()) return refuse(wsi, 411);
    if (bytes > uploads.maxBytes()) return refuse(wsi, 413);
    tidyUploads();
    if (uploading.size() >= maxUploads || uploads.isFull()) return refuse(wsi, 503);
    std::unique_ptr<Upload> upload = uploads.begin(argumentOf(wsi, "name="), bytes);
    if (!upload) return refuse(wsi, 400);
    uploading[wsi] = std::move(upload);
    return 0;
}

/// Not while the renderer has yet to open one: it does not tell that it uses it.
void WebServer::Impl::tidyUploads() {
    const auto shown = session.shown();
    if (shown->messages >= lastOpened) uploads.tidy(shown->facts.files);
}

int WebServer::Impl::receiveUpload(lws* wsi, std::span<const std::byte> bytes) {
    const auto found = uploading.find(wsi);
    return found != uploading.end() && found->second->write(bytes) ? 0 : -1;
}

int WebServer::Impl::endUpload(lws* wsi) {
    const auto found = uploading.find(wsi);
    if (found == uploading.end() || !found->second->isComplete()) return -1;
    const std::unique_ptr<Upload> upload = std::move(found->second);
    uploading.erase(found);
    lastOpened =
        session.ask({.kind = studio::Request::Kind::OpenDropped, .file = uploads.keep(*upload).string()});
    return answer(wsi, "text/plain", std::make_shared<const std::vector<std::byte>>());
}

/// On the server's thread, after another one has called wake(), and several times a second.
void WebServer::Impl::afterWake() {
    for (const auto& [wsi, client] : clients) lws_callback_on_writable(wsi);
    Bytes done;
    {
        const std::lock_guard lock(stillMutex);
        done = std::exchange(still, nullptr);
    }
    if (done) {
        for (const auto& [wsi, until] : std::exchange(waiting, {}))
            answerLater(wsi, "image/png", done, HTTP_STATUS_OK);
    }
    const auto now = Clock::now();
    std::erase_if(waiting, [&](const auto& each) {
        if (each.second > now) return false;
        answerLater(each.first, "text/plain", bytesOf("There is no picture in full size yet: try again.\n"),
                    HTTP_STATUS_GATEWAY_TIMEOUT);
        return true;
    });
}

int WebServer::Impl::sendToClient(lws* wsi, Client& client) {
    std::vector<unsigned char> buffer;
    lws_write_protocol kind = LWS_WRITE_TEXT;
    std::optional<Clock::time_point> encoded;
    if (const std::optional<std::string> text = client.nextText()) {
        buffer.resize(LWS_PRE + text->size());
        std::memcpy(buffer.data() + LWS_PRE, text->data(), text->size());
    } else if (const std::optional<Packet> packet = client.nextPacket()) {
        kind = LWS_WRITE_BINARY;
        encoded = packet->encoded;
        const auto header = packed(packet->header);
        buffer.resize(LWS_PRE + header.size() + packet->bytes->size());
        std::memcpy(buffer.data() + LWS_PRE, header.data(), header.size());
        std::memcpy(buffer.data() + LWS_PRE + header.size(), packet->bytes->data(), packet->bytes->size());
    } else {
        return 0;
    }
    const size_t size = buffer.size() - LWS_PRE;
    if (lws_write(wsi, buffer.data() + LWS_PRE, size, kind) < static_cast<int>(size)) return -1;
    if (encoded && settings.stream.timed)
        settings.stream.timed(Stage::Send,
                              std::chrono::duration<double, std::milli>(Clock::now() - *encoded).count());
    lws_callback_on_writable(wsi);
    return 0;
}

int WebServer::Impl::handleHttp(lws* wsi, lws_callback_reasons reason, void* in, size_t length) {
    switch (reason) {
        case LWS_CALLBACK_HTTP:
            return http(wsi, std::string(static_cast<const char*>(in), length));
        case LWS_CALLBACK_HTTP_WRITEABLE:
            return sendAnswer(wsi);
        case LWS_CALLBACK_HTTP_CONFIRM_UPGRADE:
            return confirmUpgrade(wsi);
        case LWS_CALLBACK_CLOSED_HTTP:
        case LWS_CALLBACK_HTTP_DROP_PROTOCOL:
            answers.erase(wsi);
            waiting.erase(wsi);
            uploading.erase(wsi);
            return 0;
        case LWS_CALLBACK_EVENT_WAIT_CANCELLED:
            afterWake();
            return 0;
        case LWS_CALLBACK_HTTP_BODY:
            return receiveUpload(wsi, {static_cast<const std::byte*>(in), length});
        case LWS_CALLBACK_HTTP_BODY_COMPLETION:
            return endUpload(wsi);
        // The library's own handling would answer to more than this server has.
        case LWS_CALLBACK_HTTP_FILE_COMPLETION:
            return -1;
        default:
            return lws_callback_http_dummy(wsi, reason, nullptr, in, length);
    }
}

int WebServer::Impl::handleSocket(lws* wsi, lws_callback_reasons reason, void* in, size_t length) {
    const auto found = clients.find(wsi);
    Client* const client = found == clients.end() ? nullptr : found->second.get();
    switch (reason) {
        case LWS_CALLBACK_ESTABLISHED:
            clients[wsi] = std::make_unique<Client>(session, *streamer, files, uploads.maxBytes());
            lws_callback_on_writable(wsi);
            return 0;
        case LWS_CALLBACK_CLOSED:
            if (client) clients.erase(found);
            return 0;
        case LWS_CALLBACK_SERVER_WRITEABLE:
            return client ? sendToClient(wsi, *client) : -1;
        case LWS_CALLBACK_RECEIVE: {
            const bool last = lws_is_final_fragment(wsi) && lws_remaining_packet_payload(wsi) == 0;
            if (client && !lws_frame_is_binary(wsi) &&
                client->receive({static_cast<const char*>(in), length}, last)) {
                lws_callback_on_writable(wsi);
                return 0;
            }
            lws_close_reason(wsi, LWS_CLOSE_STATUS_POLICY_VIOLATION, nullptr, 0);
            return -1;
        }
        default:
            return 0;
    }
}

int WebServer::Impl::onHttp(lws* wsi, lws_callback_reasons reason, void*, void* in, size_t length) {
    return guarded(wsi, reason, [&] { return of(wsi).handleHttp(wsi, reason, in, length); });
}

int WebServer::Impl::onSocket(lws* wsi, lws_callback_reasons reason, void*, void* in, size_t length) {
    return guarded(wsi, reason, [&] { return of(wsi).handleSocket(wsi, reason, in, length); });
}

WebServer::WebServer(studio::Session& session, const ServeSettings& settings, const SceneFiles& files,
                     std::string token)
    : impl_(std::make_unique<Impl>(session, settings, files, std::move(token))) {
    Impl& self = *impl_;
    lws_set_log_level(0, nullptr);
    allowManyFiles();
    self.protocols[0] = {"http", &Impl::onHttp, 0, 0, 0, nullptr, 0};
    self.protocols[1] = {"limpid", &Impl::onSocket, 0, 16384, 0, nullptr, 0};
    self.idle.secs_since_valid_ping = 20;
    self.idle.secs_since_valid_hangup = 45;
    lws_context_creation_info info{};
    info.iface = settings.bind.c_str();
    info.port = settings.port;
    info.protocols = self.protocols.data();
    info.user = &self;
    info.fd_limit_per_thread = maxConnections;
    info.timeout_secs = settings.headerSeconds;
    info.timeout_secs_ah_idle = settings.headerSeconds;
    info.keepalive_timeout = static_cast<int>(settings.headerSeconds);
    info.retry_and_idle_policy = &self.idle;
    info.server_string = "limpid";
    const std::string certificate = settings.certificate.string(), key = settings.key.string();
    if (self.tls) {
        info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
        info.ssl_cert_filepath = certificate.c_str();
        info.ssl_private_key_filepath = key.c_str();
        info.alpn = "http/1.1";
    }
    self.context.reset(lws_create_context(&info));
    if (!self.context)
        throw Error(fmt::format("{}:{} cannot be served: the address is in use or not this machine's{}",
                                settings.bind, settings.port,
                                self.tls ? ", or the certificate or its key cannot be read" : ""));
    self.streamer = std::make_unique<Streamer>(
        session, [&self] { self.wake(); }, settings.stream);
    self.listener = session.addListener([&self] { self.wake(); });
}

WebServer::~WebServer() = default;

int WebServer::port() const {
    return lws_get_vhost_listen_port(lws_get_vhost_by_name(impl_->context.get(), "default"));
}

void WebServer::run(const std::function<bool()>& stop) {
    // Ends the library's wait, so that `stop` is asked.
    struct Timer {
        lws_sorted_usec_list_t list{};
        lws_context* context = nullptr;
        static void ring(lws_sorted_usec_list_t* list) {
            auto* const self = reinterpret_cast<Timer*>(list);
            lws_sul_schedule(self->context, 0, list, &Timer::ring, tick);
            lws_cancel_service(self->context);
        }
    } timer;
    lws_context* const context = impl_->context.get();
    timer.context = context;
    lws_sul_schedule(context, 0, &timer.list, &Timer::ring, tick);
    while (!stop() && lws_service(context, 0) >= 0) {
    }
    lws_sul_schedule(context, 0, &timer.list, nullptr, LWS_SET_TIMER_USEC_CANCEL);
}

}  // namespace limpid::serve
