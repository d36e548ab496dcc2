//! Everything of `kestirim-ppp-filter`, linked.

#![no_std]
#![no_main]

surface::image!(surface::ppp_filter::run);
