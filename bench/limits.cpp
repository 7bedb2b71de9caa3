// What this machine can do at most, for the pieces that a step of springs is made of. `limits THREADS` prints one line
// of JSON; each figure is the best of several runs, with as many threads as asked for working at the same time.
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

using Vector = float __attribute__((vector_size(64)));
constexpr int LANES = sizeof(Vector) / sizeof(float), CHAINS = 12;
constexpr int REPEATS = 20;

static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Seconds of the fastest run, on all threads at once. `prepare` gives each thread the work that is then timed, so that
// every thread has touched its own memory first.
static double best(const std::function<std::function<void()>()>& prepare) {
    double seconds = 1e30;
#pragma omp parallel
    {
        const auto work = prepare();
        work();
        for (int repeat = 0; repeat < REPEATS; repeat++) {
#pragma omp barrier
            const double begun = now();
            work();
#pragma omp barrier
#pragma omp master
            seconds = std::min(seconds, now() - begun);
        }
    }
    return seconds;
}

// Keeps the compiler from leaving out what nobody reads.
template <class T>
static void used(const T& value) {
    asm volatile("" : : "r"(&value) : "memory");
}

// Independent chains of a multiplication and an addition each, enough of them to hide how long either takes.
constexpr int ROUNDS = 1 << 17; // half a millisecond or so: short enough to be left alone now and then
constexpr double ARITHMETIC = 2.0 * ROUNDS * CHAINS * LANES;

static inline __attribute__((always_inline)) void chains() {
    Vector sums[CHAINS] = {};
    Vector factor = Vector{} + 0.999f, term = Vector{} + 0.001f;
    asm volatile("" : "+m"(factor), "+m"(term)); // unknown to the compiler
    const Vector a = factor, b = term;
    for (int round = 0; round < ROUNDS; round++)
#pragma GCC unroll 12
        for (int chain = 0; chain < CHAINS; chain++) sums[chain] = sums[chain] * a + b;
    used(sums);
}

__attribute__((noinline, optimize("fp-contract=off"))) static void separate() { chains(); }
__attribute__((noinline, optimize("fp-contract=fast"))) static void fused() { chains(); }

// The loops that are timed, apart from what surrounds them, so that the compiler knows that nothing overlaps.
static void add_scaled(float* __restrict a, const float* __restrict b, const float* __restrict c, size_t count) {
    for (size_t i = 0; i < count; i++) a[i] = b[i] + 0.5f * c[i];
}

static void invert_roots(float* __restrict to, const float* __restrict from, size_t count) {
    for (size_t i = 0; i < count; i++) to[i] = 1 / std::sqrt(from[i]);
}

static void fetch(float* __restrict to, const float* __restrict table, const int32_t* __restrict place, size_t count) {
    for (size_t i = 0; i < count; i++) to[i] = table[place[i]];
}

// a = b + s·c over three arrays that take so many bytes together on each thread: GB/s as STREAM counts them.
static double triad(size_t bytes, int threads) {
    const size_t count = bytes / 3 / sizeof(float) / LANES * LANES;
    const size_t passes = std::max<size_t>(1, (16 << 20) / bytes);
    const double seconds = best([=] {
        std::vector<float> a(count, 1), b(count, 2), c(count, 3);
        return [=, a = std::move(a), b = std::move(b), c = std::move(c)]() mutable {
            for (size_t pass = 0; pass < passes; pass++) {
                add_scaled(a.data(), b.data(), c.data(), count);
                used(a[0]);
            }
        };
    });
    return threads * passes * count * 3 * sizeof(float) / seconds / 1e9;
}

constexpr size_t SMALL = 4096; // floats: 16 kB, well within the nearest cache

// 1/√x, both operations exact: ns for each number.
static double inverse_root(int threads) {
    constexpr int passes = 200;
    const double seconds = best([] {
        std::vector<float> x(SMALL, 2), y(SMALL);
        return [x, y]() mutable {
            for (int pass = 0; pass < passes; pass++) {
                invert_roots(y.data(), x.data(), SMALL);
                used(y[0]);
            }
        };
    });
    return seconds / passes / SMALL / threads * 1e9;
}

// Numbers fetched from random places of a table: ns for each.
static double gather(size_t table, int threads) {
    constexpr int passes = 200;
    const double seconds = best([=] {
        std::vector<float> from(table, 1), y(SMALL);
        std::vector<int32_t> places(SMALL * 16);
        uint32_t seed = 1;
        for (auto& place : places) place = (seed = seed * 1664525 + 1013904223) / 4294967296.0 * table;
        return [from, y, places]() mutable {
            for (int pass = 0; pass < passes; pass++) {
                fetch(y.data(), from.data(), places.data() + SMALL * (pass % 16), SMALL);
                used(y[0]);
            }
        };
    });
    return seconds / passes / SMALL / threads * 1e9;
}

static size_t cache(int level, size_t unknown) {
    const long bytes = sysconf(level);
    return bytes > 0 ? bytes : unknown;
}

int main(int, char** arguments) {
    const int threads = std::atoi(arguments[1]);
    omp_set_num_threads(threads);
    const size_t l2 = cache(_SC_LEVEL2_CACHE_SIZE, 1 << 20), l3 = cache(_SC_LEVEL3_CACHE_SIZE, 32 << 20);
    // A thread's share of the third level and well beyond the second; and beyond all levels, as far as a gigabyte goes.
    const size_t middle = std::min(8 * l2, l3 / 2 / threads), far = std::min<size_t>(4 * l3, 1 << 30) / threads;

    std::printf("{\"threads\": %d", threads);
    std::printf(", \"fused_gflops\": %.1f", threads * ARITHMETIC / best([] { return fused; }) / 1e9);
    std::printf(", \"separate_gflops\": %.1f", threads * ARITHMETIC / best([] { return separate; }) / 1e9);
    std::printf(", \"triad_l2_gbs\": %.1f", triad(l2 / 2, threads));
    std::printf(", \"triad_l3_gbs\": %.1f", triad(middle, threads));
    std::printf(", \"triad_memory_gbs\": %.1f", triad(far, threads));
    std::printf(", \"inverse_root_ns\": %.3f", inverse_root(threads));
    std::printf(", \"gather_near_ns\": %.3f", gather(SMALL, threads));
    std::printf(", \"gather_far_ns\": %.3f", gather(6 << 18, threads));
    std::printf(", \"l2_bytes\": %zu, \"l3_bytes\": %zu}\n", l2, l3);
}
