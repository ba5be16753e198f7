#include "importer/cage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <vector>

#include <grp.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace buoyancy {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kShadowMemory = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool kShadowMemory = true;
#else
constexpr bool kShadowMemory = false;
#endif
#else
constexpr bool kShadowMemory = false;
#endif

void limit_resource(__rlimit_resource resource, std::uint64_t max) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(max, limit.rlim_max);
  limit.rlim_max = std::min<rlim_t>(max + 1, limit.rlim_max);  // at which the kernel kills, without SIGXCPU
  ::setrlimit(resource, &limit);
}

std::uint64_t address_space_in_use() {
  unsigned long pages = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(statm, "%lu", &pages) != 1) pages = 0;  // NOLINT(cert-err34-c): written by the kernel
    std::fclose(statm);
  }
  return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void limit_resources(const ImportLimits& limits) {
  if (!kShadowMemory) limit_resource(RLIMIT_AS, address_space_in_use() + limits.memory_bytes);
  limit_resource(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(limits.import_seconds)) + 1);
  limit_resource(RLIMIT_CORE, 0);
  limit_resource(RLIMIT_FSIZE, 0);
}

// Makes the kernel's out-of-memory killer prefer this process to its parent.
void prefer_for_oom_kill() {
  if (std::FILE* score = std::fopen("/proc/self/oom_score_adj", "we")) {
    std::fputs("1000", score);
    std::fclose(score);
  }
}

void drop_root() {
  if (::geteuid() != 0) return;
  constexpr unsigned kNobody = 65534;
  ::setgroups(0, nullptr);
  if (::setresgid(kNobody, kNobody, kNobody) != 0) return;
  // In a user namespace that does not map this id, the process stays root of that namespace.
  [[maybe_unused]] const int not_mapped = ::setresuid(kNobody, kNobody, kNobody);
}

// The argument of landlock_create_ruleset(), of which Debian 12's headers have the first member only.
struct LandlockRules {
  std::uint64_t files;
  std::uint64_t tcp;    // from version 4 on: bind, connect
  std::uint64_t scope;  // from version 6 on: connections to sockets without a name in a folder, signals
};

// Takes away every right that Landlock in this kernel can restrict.
void close_file_systems() {
  const auto version = ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  if (version < 1) return;
  constexpr std::array<unsigned, 5> kFileRights{13, 14, 15, 15, 16};  // the lowest bits, by version
  const auto known = std::min<std::size_t>(static_cast<std::size_t>(version), kFileRights.size());
  const LandlockRules rules{(std::uint64_t{1} << kFileRights[known - 1]) - 1, 3, 3};
  const std::size_t size = version >= 6   ? sizeof(rules)
                           : version >= 4 ? offsetof(LandlockRules, scope)
                                          : offsetof(LandlockRules, tcp);
  const auto ruleset = static_cast<int>(::syscall(SYS_landlock_create_ruleset, &rules, size, 0));
  if (ruleset < 0) return;
  ::syscall(SYS_landlock_restrict_self, ruleset, 0);
  ::close(ruleset);
}

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#elif defined(__riscv) && __riscv_xlen == 64
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_RISCV64;
#else
constexpr std::uint32_t kArchitecture = 0;  // no filter
#endif

// These calls serve memory, open descriptors and the end of the process. All others fail with EPERM.
constexpr std::array kAllowedCalls{
    SYS_read,           SYS_pread64,      SYS_readv,       SYS_write,   SYS_writev,     SYS_lseek,
    SYS_close,          SYS_recvfrom,     SYS_recvmsg,     SYS_sendto,  SYS_brk,        SYS_mmap,
    SYS_munmap,         SYS_mremap,       SYS_mprotect,    SYS_madvise, SYS_futex,      SYS_rt_sigaction,
    SYS_rt_sigprocmask, SYS_rt_sigreturn, SYS_sigaltstack, SYS_getpid,  SYS_gettid,     SYS_clock_gettime,
    SYS_gettimeofday,   SYS_getrandom,    SYS_sched_yield, SYS_exit,    SYS_exit_group, SYS_restart_syscall};

void filter_system_calls() {
  if (kArchitecture == 0) return;
  constexpr auto kErrno = SECCOMP_RET_ERRNO | (EPERM & SECCOMP_RET_DATA);
  constexpr std::uint32_t kFirstArgument = offsetof(seccomp_data, args);  // its lower half: little-endian
  std::vector<sock_filter> filter{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kArchitecture, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
  };
  for (const long call : kAllowedCalls) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1));
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  // abort() sends itself a signal by tgkill(own process, thread, signal).
  const std::array own_signals{
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_tgkill, 0, 3),
      sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kFirstArgument),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(::getpid()), 0, 1),
      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      sock_filter BPF_STMT(BPF_RET | BPF_K, kErrno),
  };
  filter.insert(filter.end(), own_signals.begin(), own_signals.end());
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

}  // namespace

void enter_cage(const ImportLimits& limits) {
  limit_resources(limits);
  prefer_for_oom_kill();
  drop_root();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // after drop_root(), which would unset it
  ::prctl(PR_SET_DUMPABLE, 0);         // no core dump through a core_pattern pipe, no tracing by its user
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  close_file_systems();
  filter_system_calls();
}

}  // namespace buoyancy
