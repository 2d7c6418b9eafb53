/* The sources that a library was made of: `surefoot.native.build` looks for them in its bytes, to know a stale one.
   And how it was made: other compilers and flags give other bits, so logs and digests of results name them. */
#if !defined SUREFOOT_DIGEST || !defined SUREFOOT_FLAGS
#error "surefoot.native.build gives the digest of the sources and the flags"
#endif
#if defined __clang__
#define COMPILER "clang " __clang_version__
#elif defined __GNUC__
#define COMPILER "gcc " __VERSION__
#else
#define COMPILER "another compiler"
#endif

const char surefoot_digest[] = SUREFOOT_DIGEST;
const char surefoot_made[] = COMPILER " " SUREFOOT_FLAGS;
