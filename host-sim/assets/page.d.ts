// What the page's scripts use of others, for `tsc --checkJs`.
declare const Plotly: any;
