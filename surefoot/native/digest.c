/* The sources that a library was made of, by which `surefoot.native.library` knows a stale one. */
#ifndef SUREFOOT_DIGEST
#error "surefoot.native.build gives the digest of the sources"
#endif

const char *surefoot_digest(void) { return SUREFOOT_DIGEST; }
