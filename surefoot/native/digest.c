/* The sources that a library was made of: `surefoot.native.build` looks for them in its bytes, to know a stale one. */
#ifndef SUREFOOT_DIGEST
#error "surefoot.native.build gives the digest of the sources"
#endif

const char surefoot_digest[] = SUREFOOT_DIGEST;
